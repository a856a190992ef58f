//! The slider-crank of Flores, Leine and Glocker (2010) whose slider has play in its guide, up to the first contact with
//! the guide (I: the double pendulum in two angles, integrated with a relative tolerance of 1e-13).

use crate::support::{TestRecording, run};
use ladder::{Rung, Worst};

const SCENE: &str = "slider-crank/free-slider.toml";

/// Height of the guide's upper face \[m\].
const FACE: f64 = 0.026;
/// Angles of crank and rod, their rates, and the slider's speed towards the face, at the contact.
const LISTED: [f64; 5] = [
    0.35530445502773,
    -0.17150954094017,
    109.557681543152,
    -49.3307899619326,
    0.84161232203283,
];

/// A channel between two rows a time `h` apart, at their share `s`: the cubic through the values and rates of both.
fn between(run: &TestRecording, [value, rate]: [&str; 2], row: usize, h: f64, s: f64) -> f64 {
    let (value, rate) = (run.get(value), run.get(rate));
    let way = value[row + 1] - value[row];
    let (first, last) = (rate[row] * h, rate[row + 1] * h);
    value[row] + s * (first + s * (3.0 * way - 2.0 * first - last + s * (first + last - 2.0 * way)))
}

#[test]
fn the_slider_meets_its_guide_where_it_is_listed() {
    let (run, _) = run(SCENE, &[]);
    let t = run.get("t");
    let height = ["points.slider.front.y", "points.slider.front.vy"];
    let after = run.get(height[0]).iter().position(|y| *y >= FACE);
    let row = after.expect("the slider reaches the face") - 1;
    let h = t[row + 1] - t[row];
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match between(&run, height, row, h, middle) < FACE {
            true => low = middle,
            false => high = middle,
        }
    }
    Rung::Computed
        .asks("Slider-crank with a free slider: listed instant of the first contact with the guide [s]")
        .within(t[row] + low * h - 0.0026925, 5e-8, "five digits are listed");
    let worst = Worst::new();
    for (names, listed) in [
        (["crank.theta", "crank.omega"], LISTED[0]),
        (["rod.theta", "rod.omega"], LISTED[1]),
        (["crank.omega", "crank.alpha"], LISTED[2]),
        (["rod.omega", "rod.alpha"], LISTED[3]),
        (
            ["points.slider.front.vy", "points.slider.front.ay"],
            LISTED[4],
        ),
    ] {
        worst.at(format!("of {}", names[0]));
        worst.see(between(&run, names, row, h, low) / listed - 1.0);
    }
    Rung::Computed
        .asks("Slider-crank with a free slider: listed angles, rates and speed at that contact, relative error")
        .within(
            &worst,
            1e-12,
            "ten times the relative tolerance of the reference integration; the cubic interpolation between rows has a smaller error",
        );
    // nothing turns the slider about its pin
    assert!(run.get("slider.theta").iter().all(|theta| *theta == 0.0));
}
