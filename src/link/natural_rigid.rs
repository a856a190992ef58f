//! Rigid link in natural coordinates (eqs. 1-5): the coordinates are the positions of its two ends.

/// Mass matrix of a uniform link, rho A int S_r^T S_r dx (eq. 5), in the scalar form m_ab that stands before I_2.
pub fn mass(total_mass: f64) -> [[f64; 2]; 2] {
    let m = total_mass / 6.0;
    [[2.0 * m, m], [m, 2.0 * m]]
}
