//! Mutation by line and by value. Bytes changed at random are hardly ever TOML; these changes are, mostly, and reach the
//! checks behind the syntax and the compiler behind the checks.

use crate::{OVERRIDE, Pool};

/// Values on the edges of what numbers and types allow.
const VALUES: [&str; 42] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "64",
    "1e-320",
    "1e-200",
    "1e-12",
    "1e-6",
    "1e-3",
    "0.5",
    "1e6",
    "1e12",
    "1e200",
    "-1e300",
    "1.7976931348623157e308",
    "inf",
    "-inf",
    "nan",
    "9223372036854775807",
    "-9223372036854775808",
    "3.141592653589793",
    "[]",
    "{}",
    "\"\"",
    "true",
    "false",
    "[0, 0]",
    "[1, 0]",
    "[[0, 0], [1, 1]]",
    "[[0, 0, 0, 0], [9, 0, 0, 0]]",
    "1979-05-27",
    "\"é\"",
    "\"*\"",
    "[\"*\"]",
    "\"0.1 * sin(5 * t)\"",
    "\"t^-2\"",
    "\"1e308 * exp(t)\"",
    "\"((((t\"",
    "\"2·t\"",
    "\"max(0, log(t))\"",
];

/// Sebastiano Vigna's splitmix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Below `n`, which is not 0.
    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    fn of<'a>(&mut self, all: &'a [impl AsRef<str>]) -> &'a str {
        all.get(self.below(all.len().max(1)))
            .map_or("", AsRef::as_ref)
    }
}

/// Changes the input in `data`, of which `size` bytes count, and returns its new size: by line, but for one case in `bytes_in`
/// and for what has no lines to change, where `by_bytes` of the fuzzer changes it.
pub fn mutate(
    data: &mut [u8],
    size: usize,
    most: usize,
    seed: u32,
    bytes_in: u32,
    pool: &Pool,
    by_bytes: impl FnOnce(&mut [u8], usize, usize) -> usize,
) -> usize {
    let by_line = !seed.is_multiple_of(bytes_in);
    let changed = by_line.then(|| change_text(data, size, most, seed, pool));
    let changed = changed.flatten();
    changed.unwrap_or_else(|| by_bytes(data, size, most))
}

/// Changes the text in `data`, of which `size` bytes count, in one to four places; returns the new size, or nothing for
/// what is no text, or no longer fits.
fn change_text(data: &mut [u8], size: usize, most: usize, seed: u32, pool: &Pool) -> Option<usize> {
    let text = std::str::from_utf8(&data[..size]).ok()?;
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let mut random = Random(seed.into());
    // one change in half of the cases: of many one is mostly a fault that hides the others
    for _ in 0..=random.next().trailing_zeros().min(3) {
        change(&mut lines, &mut random, pool);
    }
    let new = lines.join("\n") + "\n";
    if new.len() > most.min(data.len()) {
        return None;
    }
    data[..new.len()].copy_from_slice(new.as_bytes());
    Some(new.len())
}

fn change(lines: &mut Vec<String>, random: &mut Random, pool: &Pool) {
    if lines.is_empty() {
        lines.push(String::new());
    }
    let (at, other) = (random.below(lines.len()), random.below(lines.len()));
    match random.below(10) {
        0 => {
            lines.remove(at);
        }
        1 => {
            let line = lines[other].clone();
            lines.insert(at, line);
        }
        2 => lines.swap(at, other),
        3 => {
            let seed = random.of(&pool.seeds);
            let blocks: Vec<&str> = seed.split("\n\n").collect();
            let block = random.of(&blocks).lines().map(str::to_owned);
            let block: Vec<String> = block.collect();
            lines.splice(at..at, block);
        }
        4 => {
            let line = format!("{} = {}", random.of(&pool.words), random.of(&VALUES));
            lines.insert(at, line);
        }
        5 => {
            let path = format!("{}.{}", random.of(&pool.words), random.of(&pool.words));
            lines.push(format!("{OVERRIDE}{path}={}", random.of(&VALUES)));
        }
        6 => {
            let value = match (random.below(2), lines[other].split_once('=')) {
                (0, Some((_, value))) => value.trim().to_owned(),
                _ => random.of(&VALUES).to_owned(),
            };
            if let Some((key, _)) = lines[at].split_once('=') {
                lines[at] = format!("{} = {value}", key.trim_end());
            }
        }
        7 => {
            let line = replace_token(
                &lines[at],
                random,
                |t| t.parse::<f64>().is_ok(),
                |token, random| match random.below(3) {
                    0 => random.of(&VALUES).to_owned(),
                    1 => format!(
                        "{:e}",
                        token.parse::<f64>().unwrap_or(1.0)
                            * 10f64.powi(random.below(25) as i32 - 12)
                    ),
                    _ => format!("-{token}"),
                },
            );
            lines[at] = line;
        }
        _ => {
            let donor = lines[other].clone();
            let is_word = |t: &str| t.starts_with(|c: char| c.is_ascii_alphabetic());
            let line = replace_token(&lines[at], random, is_word, |_, random| {
                let words: Vec<&str> = tokens(&donor).map(|t| t.1).filter(|t| is_word(t)).collect();
                match random.below(2) {
                    0 if !words.is_empty() => random.of(&words).to_owned(),
                    _ => random.of(&pool.words).trim_matches('"').to_owned(),
                }
            });
            lines[at] = line;
        }
    }
}

/// Runs of characters of names and numbers, with their places.
fn tokens(line: &str) -> impl Iterator<Item = (usize, &str)> {
    let is_part = |c: char| c.is_alphanumeric() || "._+-".contains(c);
    line.split(move |c| !is_part(c))
        .filter(|token| !token.is_empty())
        .map(move |token| (token.as_ptr() as usize - line.as_ptr() as usize, token))
}

/// `line` with one of the tokens that `wanted` accepts changed.
fn replace_token(
    line: &str,
    random: &mut Random,
    wanted: impl Fn(&str) -> bool,
    new: impl Fn(&str, &mut Random) -> String,
) -> String {
    let found: Vec<_> = tokens(line).filter(|(_, token)| wanted(token)).collect();
    if found.is_empty() {
        return line.to_owned();
    }
    let (at, token) = found[random.below(found.len())];
    format!(
        "{}{}{}",
        &line[..at],
        new(token, random),
        &line[at + token.len()..]
    )
}
