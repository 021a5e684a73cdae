//! How a push is divided among pressing planes.

use glam::{DMat3, DVec3};

/// Weight of the shares' own size against the misfit. Multipliers between nearly opposite planes explode (a slot gave 285 N·m at 72 N);
/// this bounds every share by |push|/(2√ρ) = 5 |push| and changes well separated ones by about 1 %, which the caller's remainder term carries.
const REGULARISATION: f64 = 1e-2;

/// Shares t ≥ 0 [m] that minimise |Σ tᵢ nᵢ − push|² + ρ Σ tᵢ² (contact.12), for up to three unit normals.
pub(crate) fn regularised_shares(normals: &[DVec3], push: DVec3) -> [f64; 3] {
    let mut shares = [0.0; 3];
    if let [normal] = normals {
        shares[0] = normal.dot(push).max(0.0);
        return shares;
    }
    let mut used = [true; 3];
    used[normals.len()..].fill(false);
    // At most three normals: dropping the most negative share until none is left takes at most three solves.
    for _ in 0..3 {
        let gram = |i: usize, j: usize| match (i == j, used[i] && used[j]) {
            (true, true) => 1.0 + REGULARISATION,
            (true, false) => 1.0,
            (false, true) => normals[i].dot(normals[j]),
            (false, false) => 0.0,
        };
        let column = |j: usize| DVec3::new(gram(0, j), gram(1, j), gram(2, j));
        let right = |i: usize| if used[i] { normals[i].dot(push) } else { 0.0 };
        let matrix = DMat3::from_cols(column(0), column(1), column(2));
        shares = (matrix.inverse() * DVec3::new(right(0), right(1), right(2))).to_array();
        let worst = (0..3)
            .filter(|&i| used[i] && shares[i] < 0.0)
            .min_by(|&i, &j| shares[i].total_cmp(&shares[j]));
        match worst {
            Some(i) => used[i] = false,
            None => break,
        }
    }
    shares.map(|share| share.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::regularised_shares;
    use glam::DVec3;

    #[test]
    fn one_plane_carries_the_whole_push() {
        let shares = regularised_shares(&[DVec3::Z], DVec3::Z * 2e-3);
        assert!((shares[0] - 2e-3).abs() < 1e-18 && shares[1] + shares[2] < 1e-18);
    }

    #[test]
    fn orthogonal_planes_carry_their_components() {
        let shares = regularised_shares(&[DVec3::X, DVec3::Y], DVec3::new(1e-3, 3e-3, 0.0));
        assert!((shares[0] - 1e-3).abs() < 2e-5 && (shares[1] - 3e-3).abs() < 4e-5);
    }

    #[test]
    fn nearly_opposite_planes_do_not_explode() {
        let tilted = DVec3::new(1e-5, 0.0, -1.0).normalize();
        let push = DVec3::new(1e-3, 0.0, 0.0);
        let shares = regularised_shares(&[DVec3::Z, tilted], push);
        // The exact multipliers would be 100 m.
        assert!(
            shares.iter().all(|s| (0.0..=5e-3).contains(s)),
            "{shares:?}"
        );
    }
}
