//! A linear system against the trait that mechanisms implement: masses and springs in a row.

use looselink::math::lu::Symbolic;
use looselink::math::saddle_point::SaddlePoint;
use looselink::stepper::Method;
use looselink::system::{Changed, Operations, PrescribeError, Shape, State, System, Weights, Work};

/// Masses and springs in series between walls: m_i a_i + d v_i + (K q)_i = 0.
#[derive(Debug)]
pub struct Chain {
    pub masses: Vec<f64>,
    pub springs: Vec<f64>,
    /// d, of a damper between every mass and the ground.
    pub damping: f64,
    /// States after this time cannot be prescribed.
    pub prescribed_until: f64,
    symbolic: Symbolic,
    acceleration_matrix: SaddlePoint,
}

impl Chain {
    pub fn new(masses: Vec<f64>, springs: Vec<f64>) -> Chain {
        let n = masses.len();
        assert_eq!(springs.len(), n + 1);
        let cliques: Vec<Vec<usize>> = (0..n)
            .map(|i| if i + 1 < n { vec![i, i + 1] } else { vec![i] })
            .collect();
        let diagonal = masses.iter().enumerate().map(|(i, m)| (i, i, *m));
        Chain {
            springs,
            damping: 0.0,
            prescribed_until: f64::INFINITY,
            symbolic: Symbolic::analyse(n, &cliques, &vec![vec![]; n]),
            acceleration_matrix: SaddlePoint::new(n, diagonal.collect(), &[]),
            masses,
        }
    }

    /// Of spring i, from mass i - 1 to mass i.
    pub fn stretch(&self, i: usize, q: &[f64]) -> f64 {
        let at = |k: usize| if k == 0 || k > q.len() { 0.0 } else { q[k - 1] };
        at(i + 1) - at(i)
    }
}

impl System for Chain {
    fn shape(&self) -> Shape {
        let n = self.masses.len();
        Shape {
            unknowns: n,
            coordinates: n,
            multipliers: 0,
            contacts: 0,
            crossings: 0,
            memory: 0,
            entries: 3,
        }
    }
    fn symbolic(&self) -> &Symbolic {
        &self.symbolic
    }
    fn acceleration_matrix(&self) -> &SaddlePoint {
        &self.acceleration_matrix
    }
    fn operations(&self) -> Operations {
        let springs = self.springs.len() as u64;
        Operations {
            residual: 2 * springs,
            tangent: 6 * springs,
        }
    }
    fn work(&self) -> Work {
        Work {
            tally: vec![],
            prescribed: Vec::new(),
        }
    }
    fn prescribe(&self, _: &State, to: &mut State, _: &mut Work) -> Result<(), PrescribeError> {
        match to.t > self.prescribed_until {
            true => Err(PrescribeError {
                message: "the motion ends".to_owned(),
                t: to.t,
            }),
            false => Ok(()),
        }
    }
    fn momentum(&self, x: &[f64], out: &mut [f64]) {
        for ((out, m), x) in out.iter_mut().zip(&self.masses).zip(x) {
            *out = m * x;
        }
    }
    fn residual(&self, at: &State, r: &mut [f64], _: &mut [f64], _: &mut Work) {
        for i in 0..self.masses.len() {
            let pull = self.springs[i] * self.stretch(i, &at.q)
                - self.springs[i + 1] * self.stretch(i + 1, &at.q);
            r[i] = self.masses[i] * at.a[i] + self.damping * at.v[i] + pull;
        }
    }
    fn linearise(
        &self,
        at: &State,
        w: Weights,
        r: &mut [f64],
        phi: &mut [f64],
        k: &mut [f64],
        work: &mut Work,
    ) {
        self.residual(at, r, phi, work);
        k.fill(0.0);
        for i in 0..self.masses.len() {
            k[self.symbolic.slot(i, i) as usize] =
                self.masses[i] + w.v * self.damping + w.q * (self.springs[i] + self.springs[i + 1]);
            if i + 1 < self.masses.len() {
                k[self.symbolic.slot(i, i + 1) as usize] = -w.q * self.springs[i + 1];
                k[self.symbolic.slot(i + 1, i) as usize] = -w.q * self.springs[i + 1];
            }
        }
    }
    fn acceleration_level(&self, _: &State, _: &mut [f64], _: &mut [f64]) {}
    fn free_residual(&self, at: &State, r: &mut [f64], work: &mut Work) {
        let still = State {
            a: vec![0.0; self.masses.len()],
            ..at.clone()
        };
        self.residual(&still, r, &mut [], work);
    }
    fn constraint_velocity(&self, _: &State, _: &mut [f64]) {}
    fn constraint_acceleration(&self, _: &State, _: &mut [f64]) {}
    fn crossings(&self, _: &State, _: &mut [[f64; 2]]) {}
    fn commit(&self, _: &mut State, _: &[[f64; 2]], _: f64, _: &mut dyn FnMut(Changed)) {}
    /// Integrands of known integrals, the first three powers of t; one clamp a state.
    fn powers(&self, at: &mut State, _: &mut Work) -> usize {
        at.powers[..3].copy_from_slice(&[1.0, at.t, at.t * at.t]);
        1
    }
    fn is_smooth(&self, _: &State) -> bool {
        true
    }
    fn unknown_name(&self, index: usize) -> String {
        format!("mass {index}")
    }
}

/// Bathe's scheme with this splitting and spectral radius 0.
pub fn bathe(gamma: f64) -> Method {
    Method::new(&looselink::stepper::bathe::SCHEME).with("gamma", gamma)
}
