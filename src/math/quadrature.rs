//! Gauss-Legendre quadrature on \[0, 1\].

/// Five points and weights, exact for polynomials of degree 9; the integrand of the axial force (eq. 12) has degree 8.
pub const GAUSS5: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

#[cfg(test)]
mod tests {
    use super::GAUSS5;

    #[test]
    fn five_points_are_exact_to_degree_nine_and_no_further() {
        for degree in 0..=10 {
            let sum: f64 = GAUSS5.iter().map(|(x, w)| w * x.powi(degree)).sum();
            let error = (sum - 1.0 / f64::from(degree + 1)).abs();
            // a few roundings of numbers below one; at degree 10 the error of the rule is 1/698544
            if degree <= 9 {
                assert!(error < 4e-16, "degree {degree}: {error:e}");
            } else {
                assert!(error > 1e-6, "degree {degree}: {error:e}");
            }
        }
    }
}
