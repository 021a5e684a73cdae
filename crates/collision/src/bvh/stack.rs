//! Stack of tree traversals, on the machine stack: trees are never deeper than it holds.

/// Most edges between a tree's root and a leaf. Trees over 10⁶ triangles are about 40 deep; a tree that would be deeper is
/// built balanced instead (see [`super::tree`]), which 2³² leaves do in 32.
pub(super) const DEPTH_LIMIT: usize = 62;

/// Room of a depth-first traversal: one waiting sibling per level, and the node at hand.
const ROOM: usize = DEPTH_LIMIT + 2;

/// Node indices with their bounds.
pub(crate) struct Stack {
    entries: [(u32, f64); ROOM],
    len: usize,
}

impl Stack {
    pub(crate) fn new() -> Self {
        Self {
            entries: [(0, 0.0); ROOM],
            len: 0,
        }
    }

    /// Never full: a traversal that pushes both children of the node it popped holds at most depth + 1 entries.
    pub(crate) fn push(&mut self, node: u32, bound: f64) {
        self.entries[self.len] = (node, bound);
        self.len += 1;
    }

    pub(crate) fn pop(&mut self) -> Option<(u32, f64)> {
        self.len = self.len.checked_sub(1)?;
        Some(self.entries[self.len])
    }
}
