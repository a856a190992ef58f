//! One ANCF element: mass, elastic force, tangent and energy on random physical states.

use crate::check::{Agreement, Worst, largest};
use crate::reference::{Error, element_elastic, element_mass};
use looselink::link::{AncfCable, ElasticRoute};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// States that are tried.
pub const STATES: usize = 1000;

/// An element with its state.
struct Sample {
    length: f64,
    /// EA \[N\] and EI \[N m2\].
    stiffness: [f64; 2],
    mass: f64,
    q: [f64; 8],
    /// Size of the deformation.
    strain: f64,
}

/// A number between `low` and `high`, evenly spread over the orders of magnitude.
pub fn log_uniform(random: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    random.random_range(low.ln()..high.ln()).exp()
}

/// An element of 2 cm to 1 m anywhere within 1 m, turned by any angle, stretched and bent by 1e-9 to 1.
fn sample(random: &mut ChaCha8Rng) -> Sample {
    let length = log_uniform(random, 0.02, 1.0);
    let strain = log_uniform(random, 1e-9, 1.0);
    let mut straight = [0.0, 0.0, 1.0, 0.0, length, 0.0, 1.0, 0.0];
    for (i, x) in straight.iter_mut().enumerate() {
        let scale = if i % 4 < 2 { length } else { 1.0 };
        *x += 0.5 * strain * scale * random.random_range(-1.0..1.0);
    }
    let (sin, cos) = random.random_range(0.0..TAU).sin_cos();
    let at: [f64; 2] = [
        random.random_range(-1.0..1.0),
        random.random_range(-1.0..1.0),
    ];
    let mut q = [0.0; 8];
    for i in [0, 2, 4, 6] {
        let (x, y) = (straight[i], straight[i + 1]);
        let shift = if i % 4 == 0 { at } else { [0.0; 2] };
        q[i] = cos * x - sin * y + shift[0];
        q[i + 1] = sin * x + cos * y + shift[1];
    }
    Sample {
        length,
        stiffness: [
            log_uniform(random, 1e3, 1e8),
            log_uniform(random, 1e-3, 1e4),
        ],
        mass: log_uniform(random, 1e-3, 1e1),
        q,
        strain,
    }
}

/// The rows.
///
/// # Errors
/// When the reference refuses a state.
pub fn agreements() -> Result<Vec<Agreement>, Error> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let [mut mass, mut force, mut tangent, mut energy] = [Worst::default(); 4];
    let mut smallest = f64::INFINITY;
    for _ in 0..STATES {
        let s = sample(&mut random);
        smallest = smallest.min(s.strain);
        compare_mass(&s, &mut mass)?;
        let [ea, ei] = s.stiffness;
        let element = AncfCable::new(s.length, ea, ei);
        let (mut f, mut k) = ([0.0; 8], [[0.0; 8]; 8]);
        element.force_and_tangent(&s.q, &mut f, &mut k);
        let cpp = element_elastic(s.stiffness, s.length, &s.q)?;

        // in (r/l, r') divided by l: forces as they are, moments over l
        let scaled = |f: &[f64; 8]| -> Vec<f64> {
            let scale = |i: usize| if i % 4 < 2 { 1.0 } else { s.length };
            f.iter().enumerate().map(|(i, f)| f / scale(i)).collect()
        };
        let coordinates = s.q.iter().enumerate();
        let size = coordinates.map(|(i, q)| if i % 4 < 2 { q / s.length } else { *q });
        let size = size.fold(0.0_f64, |m, x| m + x * x).sqrt();
        let unit = (ea + ei / s.length.powi(2)) * size.powi(3).max(1.0);
        force.see_scaled(&scaled(&f), &scaled(&cpp.force), unit);
        tangent.see_all(k.as_flattened(), &cpp.tangent);
        let (axial, bending) = element.energy(&s.q);
        let unit = unit * s.length * size;
        energy.see_scaled(&[axial, bending], &cpp.energy, unit);
    }
    assert!(
        smallest < 1e-8,
        "states of small strain are where rounding matters"
    );
    let scene = format!("{STATES} random states");
    let rounding = "of (EA + EI/l²) max(1, |q|³) with q = (r/l, r′): at small strain the force is a difference of terms \
                    of that size";
    Ok(vec![
        mass.row(
            "mass matrix of an element",
            &scene,
            1e-12,
            "of the largest entry; rounding",
        ),
        force.row("elastic force of an element", &scene, 1e-13, rounding),
        tangent.row(
            "elastic tangent of an element",
            &scene,
            1e-12,
            "of the largest entry; rounding",
        ),
        energy.row(
            "elastic energy of an element",
            &scene,
            1e-13,
            "of (EA + EI/l²) l max(1, |q|⁴); rounding as for the force",
        ),
    ])
}

fn compare_mass(s: &Sample, worst: &mut Worst) -> Result<(), Error> {
    let small = AncfCable::mass(s.length, s.mass / s.length);
    let mut matrix = [0.0; 64];
    for (i, row) in small.iter().enumerate() {
        for (j, m) in row.iter().enumerate() {
            for d in 0..2 {
                matrix[8 * (2 * i + d) + 2 * j + d] = *m;
            }
        }
    }
    let cpp = element_mass(s.mass, s.length)?;
    worst.see_scaled(&matrix, &cpp, largest(&cpp));
    Ok(())
}
