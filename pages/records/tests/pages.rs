//! Which records a change outdates, and what pages say of it.

use crate::support::SourceCopy;
use records::{RecordRegistry, RunningCampaign, check, root, write_notes};
use std::fs;

const BENCHMARKS: &str = "pages/benchmarks/benchmarks.json";
/// What rests on motions.
const MOTIONS: [&str; 10] = [
    "ACCURACY.md",
    "STABILITY.md",
    BENCHMARKS,
    "pages/accuracy/guarantee.jsonl",
    "paper-figures/figures/ensembles.json",
    "paper-figures/figures/numbers.json",
    "paper-figures/figures/scans.json",
    "pages/stability/records/long.json",
    "pages/stability/records/soak.json",
    "verify/REPORT.md",
];
const FAULTS: &str = "verify/faults.json";
const CONSTANTS: &str = "pages/ladder/constants.json";
const FUZZ: &str = "pages/stability/records/fuzz.json";
const MUTANTS: &str = "pages/ladder/mutation.json";
const MUTANTS_OF_ALL: &str = "pages/ladder/mutation-solver.json";

fn sorted<'a>(files: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut files: Vec<String> = files.into_iter().map(str::to_owned).collect();
    files.sort();
    files
}

#[test]
fn a_changed_token_of_a_kernel_outdates_the_records_that_depend_on_it() {
    let copy = SourceCopy::new();
    let kernels = [
        ("src/link/ancf_cable.rs", "+=", "-="),
        ("src/contact/normal/damped_power.rs", "1.5", "1.4"),
        ("src/constraint/length.rs", "2.0", "3.0"),
        ("src/interaction/torque.rs", "-1.0", "1.0"),
        ("src/stepper/bathe.rs", " * ", " / "),
    ];
    for (file, from, to) in kernels {
        // the first line of code that has it
        let text = copy.read(file);
        let is_code = |line: &&str| !line.trim_start().starts_with("//") && line.contains(from);
        let line = text.lines().find(is_code);
        let line = line.unwrap_or_else(|| panic!("{file} has no {from:?}"));
        copy.change(file, line, &line.replacen(from, to, 1));
        for line in copy.outdated() {
            println!("{line}");
        }
        let mut outdated = copy.outdated_by(file);
        outdated.sort();
        // inputs of the fuzzer are compiled, not moved
        let fuzz = (!file.starts_with("src/stepper")).then_some(FUZZ);
        // of the kernels the element and the schemes have numbers that are changed one at a time
        let numbers = ["src/link", "src/stepper"]
            .iter()
            .any(|f| file.starts_with(f));
        let few = fuzz.into_iter().chain(numbers.then_some(CONSTANTS));
        let expected = MOTIONS
            .into_iter()
            .chain([FAULTS, MUTANTS, MUTANTS_OF_ALL])
            .chain(few);
        assert_eq!(outdated, sorted(expected), "{file}");
        copy.write(file, &text);

        let commented = format!(
            "//! Another title.\n{}",
            text.replace("    /// ", "    /// Indeed: ")
        );
        copy.write(file, &commented.replace(" {\n", " { // as before\n"));
        assert_eq!(copy.outdated(), [""; 0], "{file}");
        copy.write(file, &text);
    }
}

#[test]
fn what_a_record_does_not_depend_on_does_not_outdate_it() {
    let copy = SourceCopy::new();
    let cases: [(&str, &str, &str, &[&str]); 8] = [
        (
            "crates/cli/src/run.rs",
            "fn ",
            "async fn ",
            &[MUTANTS_OF_ALL],
        ),
        (
            "scenes/3rrr/case3.toml",
            "clearance = ",
            "clearance = 1",
            &[
                "ACCURACY.md",
                "STABILITY.md",
                "pages/accuracy/guarantee.jsonl",
                "paper-figures/figures/ensembles.json",
                "paper-figures/figures/numbers.json",
                "paper-figures/figures/scans.json",
                "pages/stability/records/long.json",
                "verify/REPORT.md",
                BENCHMARKS,
                FAULTS,
            ],
        ),
        ("scenes/3rrr/case3.toml", "#", "# Indeed:", &[]),
        (
            "studies/case3.toml",
            "duration = ",
            "duration = 1",
            &["ACCURACY.md", BENCHMARKS],
        ),
        (
            "pages/stability/maps/08-grazing.toml",
            "values = [",
            "values = [1.0, ",
            &["STABILITY.md"],
        ),
        (
            "reference-cpp/src/read_contact.cpp",
            "return ",
            "return 2 * ",
            &["ACCURACY.md", "verify/REPORT.md", BENCHMARKS, FAULTS],
        ),
        (
            "reference-cpp/src/read_contact.cpp",
            "\n}",
            " // done\n\n\n}",
            &[],
        ),
        (
            "tests/link.rs",
            "assert",
            "debug_assert",
            &[MUTANTS, MUTANTS_OF_ALL, CONSTANTS],
        ),
    ];
    for (file, from, to, outdated) in cases {
        let before = copy.change(file, from, to);
        let mut found = copy.outdated_by(file);
        found.sort();
        assert_eq!(found, sorted(outdated.iter().copied()), "{file}: {to}");
        copy.write(file, &before);
    }
}

#[test]
fn files_that_come_and_go_outdate_too() {
    let copy = SourceCopy::new();
    copy.write("src/force/magnet.rs", "//! A magnet.\n");
    assert!(
        copy.outdated_by("src/force/magnet.rs")
            .contains(&MUTANTS.to_owned())
    );
    fs::remove_file(copy.path("src/force/magnet.rs")).unwrap();
    assert_eq!(copy.outdated(), [""; 0]);
    fs::remove_file(copy.path("src/interaction/torque.rs")).unwrap();
    assert!(
        copy.outdated_by("src/interaction/torque.rs")
            .contains(&MUTANTS.to_owned())
    );
}

#[test]
fn a_campaign_makes_its_record_current_unless_sources_change_while_it_runs() {
    let copy = SourceCopy::new();
    copy.change("src/link/ancf_cable.rs", "fn ", "const fn ");
    let before = copy.outdated();
    let campaign = RunningCampaign::begin_in(copy.root(), "mutation").unwrap();
    campaign.finish().unwrap();
    let after = copy.outdated();
    assert_eq!(after.len(), before.len() - 1);
    assert!(!after.iter().any(|line| line.starts_with(MUTANTS)));
    assert_eq!(check(copy.root()).unwrap().failures, [""; 0]);

    let campaign = RunningCampaign::begin_in(copy.root(), "mutation").unwrap();
    copy.change("src/link/ancf_cable.rs", "const fn ", "fn ");
    campaign.finish().unwrap();
    assert_eq!(copy.outdated_by("src/link/ancf_cable.rs"), [MUTANTS]);
    assert_eq!(check(copy.root()).unwrap().failures, [""; 0]);
}

#[test]
fn a_page_that_does_not_say_so_fails() {
    let copy = SourceCopy::new();
    let failures = || check(copy.root()).unwrap().failures;
    let pages = [
        "ACCURACY.md",
        "BENCHMARKS.md",
        "STABILITY.md",
        "VERIFICATION.md",
        "pages/accuracy/GUARANTEE.md",
        "paper-figures/ENSEMBLES.md",
        "paper-figures/REPRODUCTION.md",
        "paper-figures/SCANS.md",
        "verify/REPORT.md",
    ];
    let current = pages.map(|page| copy.read(page));
    let kernel = copy.change("src/stepper/bathe.rs", "fn ", "const fn ");
    let unsaid = failures();
    assert_eq!(unsaid.len(), 14, "{unsaid:#?}");
    write_notes(copy.root()).unwrap();
    assert_eq!(failures(), [""; 0]);
    for page in pages {
        let text = copy.read(page);
        assert!(
            text.contains("> **Recorded with an earlier state of the code.**"),
            "{page}"
        );
        assert!(
            text.contains("Changed since then: `src/stepper/bathe.rs`"),
            "{page}"
        );
    }
    // said without reason
    copy.write("src/stepper/bathe.rs", &kernel);
    assert_eq!(failures().len(), 14);
    write_notes(copy.root()).unwrap();
    assert_eq!(pages.map(|page| copy.read(page)), current);
    // without a place, and with one for what is no record
    let without = copy.change(
        "ACCURACY.md",
        "<!-- record: accuracy -->\n<!-- /record -->\n",
        "",
    );
    assert_eq!(
        failures(),
        ["ACCURACY.md has no place for the note of record accuracy"]
    );
    copy.write(
        "ACCURACY.md",
        &without.replace("record: accuracy", "record: taste"),
    );
    assert_eq!(failures().len(), 2);
    copy.write("ACCURACY.md", &without);
    // without digests
    fs::remove_file(copy.path("pages/records/state/mutation.json")).unwrap();
    assert_eq!(
        failures(),
        ["VERIFICATION.md does not say of which state record mutation is"]
    );
    write_notes(copy.root()).unwrap();
    assert!(
        copy.read("VERIFICATION.md")
            .contains("unknown earlier state")
    );
    assert_eq!(failures(), [""; 0]);
}

/// A test of the kernels that is not in the registry could change in silence.
#[test]
fn mutation_depends_on_all_tests_of_the_kernels() {
    let text = fs::read_to_string(root().join("tests/kernels.rs")).unwrap();
    let registry = RecordRegistry::read(&root()).unwrap();
    let sources = registry
        .sources(registry.record("mutation").unwrap())
        .unwrap();
    let modules = syn::parse_file(&text).unwrap().items.into_iter();
    let mut seen = 0;
    for module in modules.filter_map(|item| match item {
        syn::Item::Mod(module) => Some(module),
        _ => None,
    }) {
        let path = module.attrs.iter().find_map(|a| match &a.meta {
            syn::Meta::NameValue(path) if path.path.is_ident("path") => match &path.value {
                syn::Expr::Lit(syn::ExprLit {
                    lit: syn::Lit::Str(path),
                    ..
                }) => Some(path.value()),
                _ => None,
            },
            _ => None,
        });
        let path = path.unwrap_or_else(|| format!("{}.rs", module.ident));
        assert!(sources.contains(&format!("tests/{path}")), "tests/{path}");
        seen += 1;
    }
    assert!(seen > 5);
}
