//! Which vertices of a mesh lie at exactly the same place, so that neighbours are known on meshes that repeat vertices.

use glam::DVec3;

/// For each vertex the lowest-numbered one at its position; `None` if every position occurs once.
pub(super) fn representatives(positions: &[DVec3]) -> Option<Vec<u32>> {
    // Negative zero is zero.
    let key = |vertex: u32| (positions[vertex as usize] + 0.0).to_array();
    let before = |a: [f64; 3], b: [f64; 3]| {
        a[0].total_cmp(&b[0])
            .then(a[1].total_cmp(&b[1]))
            .then(a[2].total_cmp(&b[2]))
    };
    let mut sorted: Vec<u32> = (0..).take(positions.len()).collect();
    sorted.sort_unstable_by(|&a, &b| before(key(a), key(b)).then(a.cmp(&b)));
    let repeats = |pair: &[u32]| before(key(pair[0]), key(pair[1])).is_eq();
    if !sorted.windows(2).any(repeats) {
        return None;
    }
    let mut of: Vec<u32> = (0..).take(positions.len()).collect();
    for pair in sorted.windows(2) {
        if repeats(pair) {
            of[pair[1] as usize] = of[pair[0] as usize];
        }
    }
    Some(of)
}
