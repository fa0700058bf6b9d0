//! Eigenvalues and eigenvectors of small symmetric matrices.

/// Jacobi's method converges quadratically: matrices of this size take about six sweeps.
const MOST_SWEEPS: u32 = 40;

/// The eigenvalues of a symmetric matrix with finite elements, largest first, each with its unit eigenvector, by cyclic
/// Jacobi rotations (Golub and Van Loan 1996, section 8.4).
pub(super) fn symmetric_eigen<const N: usize>(mut matrix: [[f64; N]; N]) -> [(f64, [f64; N]); N] {
    // Rows are the eigenvectors.
    let mut vectors = [[0.0; N]; N];
    (0..N).for_each(|i| vectors[i][i] = 1.0);
    for _ in 0..MOST_SWEEPS {
        let mut has_turned = false;
        for p in 0..N {
            for q in p + 1..N {
                has_turned |= annihilate(&mut matrix, &mut vectors, p, q);
            }
        }
        if !has_turned {
            break;
        }
    }
    let mut pairs: [(f64, [f64; N]); N] = std::array::from_fn(|i| (matrix[i][i], vectors[i]));
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
    pairs
}

/// Turns the axes p and q so that the element between them is 0; false where it already does not matter.
fn annihilate<const N: usize>(
    matrix: &mut [[f64; N]; N],
    vectors: &mut [[f64; N]; N],
    p: usize,
    q: usize,
) -> bool {
    let (between, at_p, at_q) = (matrix[p][q], matrix[p][p], matrix[q][q]);
    if between.abs() <= f64::EPSILON * f64::EPSILON * (at_p.abs() + at_q.abs()) {
        return false;
    }
    let cotangent = (at_q - at_p) / (2.0 * between);
    let tangent = cotangent.signum() / (cotangent.abs() + cotangent.hypot(1.0));
    let cosine = tangent.hypot(1.0).recip();
    let sine = tangent * cosine;
    for row in matrix.iter_mut() {
        (row[p], row[q]) = (cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]);
    }
    for rows in [matrix, vectors] {
        let (row_p, row_q) = (rows[p], rows[q]);
        rows[p] = std::array::from_fn(|column| cosine * row_p[column] - sine * row_q[column]);
        rows[q] = std::array::from_fn(|column| sine * row_p[column] + cosine * row_q[column]);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(crate::fixed_seed::config())]

        #[test]
        fn a_matrix_is_the_sum_of_its_parts(numbers in prop::array::uniform16(-1e3..1e3_f64)) {
            let matrix: [[f64; 4]; 4] =
                std::array::from_fn(|i| std::array::from_fn(|j| numbers[4 * i.min(j) + i.max(j)]));
            let parts = symmetric_eigen(matrix);
            for i in 0..4 {
                for j in 0..4 {
                    let sum: f64 = parts.iter().map(|(value, vector)| value * vector[i] * vector[j]).sum();
                    prop_assert!((sum - matrix[i][j]).abs() < 1e-11, "{parts:?}");
                }
            }
            prop_assert!(parts.windows(2).all(|pair| pair[0].0 >= pair[1].0));
        }
    }

    #[test]
    fn degenerate_matrices_have_eigenvectors_too() {
        assert_eq!(symmetric_eigen([[0.0; 3]; 3]).map(|(value, _)| value), [0.0; 3]);
        let [(largest, vector), ..] = symmetric_eigen([[1.0; 3]; 3]);
        assert!((largest - 3.0).abs() < 1e-15);
        assert!(vector.iter().all(|c| (c.abs() - 3.0_f64.sqrt().recip()).abs() < 1e-15), "{vector:?}");
    }
}
