//! Stack of tree traversals: on the machine stack for any tree met in practice, on the heap beyond.

/// Binary trees over 10⁶ triangles are about 40 deep.
const INLINE: usize = 96;

/// Node indices with their bounds.
pub(super) struct Stack {
    inline: [(u32, f64); INLINE],
    len: usize,
    spilled: Vec<(u32, f64)>,
}

impl Stack {
    pub(super) fn new() -> Self {
        Self {
            inline: [(0, 0.0); INLINE],
            len: 0,
            spilled: Vec::new(),
        }
    }

    pub(super) fn push(&mut self, node: u32, bound: f64) {
        if self.len < INLINE {
            self.inline[self.len] = (node, bound);
            self.len += 1;
        } else {
            self.spilled.push((node, bound));
        }
    }

    pub(super) fn pop(&mut self) -> Option<(u32, f64)> {
        if let Some(top) = self.spilled.pop() {
            return Some(top);
        }
        self.len = self.len.checked_sub(1)?;
        Some(self.inline[self.len])
    }
}

#[cfg(test)]
mod tests {
    use super::{INLINE, Stack};

    #[test]
    fn last_in_is_first_out_across_the_spill() {
        let mut stack = Stack::new();
        let count = u32::try_from(2 * INLINE).expect("small");
        for node in 0..count {
            stack.push(node, f64::from(node));
        }
        for node in (0..count).rev() {
            assert_eq!(stack.pop(), Some((node, f64::from(node))));
        }
        assert_eq!(stack.pop(), None);
    }
}
