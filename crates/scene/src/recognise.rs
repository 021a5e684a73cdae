//! What a file that is no scene looks like: a trajectory, a mesh and a picture are easily named in a scene's place.

/// How a file that is no scene can be used instead, or what it is; `None` where it may be a scene with a fault.
///
/// A scene begins with `(`, with an attribute `#![…]` or with its name, `Scene`, after blanks and comments.
pub(crate) fn not_a_scene(bytes: &[u8]) -> Option<String> {
    let found = if bytes.iter().all(u8::is_ascii_whitespace) {
        "the file is empty".to_owned()
    } else {
        let kind = binary(bytes).or_else(|| textual(str::from_utf8(bytes).ok()?))?;
        format!("this looks like {kind}, not a scene")
    };
    Some(format!("{found}; a scene is a RON text beginning with `(`"))
}

const MESH: &str = "a mesh";
const MOTION: &str = "a trajectory";

/// Bytes that no text begins with.
fn binary(bytes: &[u8]) -> Option<&'static str> {
    /// Bytes looked at; a triangle of a binary STL file begins at byte 84.
    const HEAD: usize = 1024;
    if bytes.starts_with(b"glTF") {
        return Some(MESH);
    }
    if let Some(count) = bytes.get(80..84) {
        let count = u64::from(u32::from_le_bytes([count[0], count[1], count[2], count[3]]));
        if bytes.len() as u64 == 84 + 50 * count {
            return Some(MESH);
        }
    }
    // Text in UTF-16 is full of zeros; what to do about it is said where the encoding is checked.
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return None;
    }
    let is_control = |byte: &u8| matches!(byte, 0..=8 | 14..=31);
    let head = &bytes[..bytes.len().min(HEAD)];
    head.iter().any(is_control).then_some("binary data")
}

/// What a text that does not begin like a scene begins like.
fn textual(text: &str) -> Option<&'static str> {
    let lines = text.lines().map(str::trim);
    let first = lines
        .clone()
        .find(|line| !line.is_empty() && !line.starts_with("//"))?;
    if first.starts_with('(') || first.starts_with("#![") || first.starts_with("/*") {
        return None;
    }
    if let Some(rest) = first.strip_prefix("Scene")
        && rest.trim_start().chars().next().is_none_or(|c| c == '(')
    {
        return None;
    }
    // Both kinds of files have comments that begin with `#`.
    let data = lines
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .take(2)
        .find(|line| !line.is_empty())
        .unwrap_or(first);
    let word = data.split_whitespace().next().unwrap_or(data);
    let kind = match word {
        "v" | "vn" | "vt" | "f" | "o" | "g" | "s" | "mtllib" | "usemtl" | "solid" => MESH,
        _ if data.starts_with('{') && text.contains("\"asset\"") => MESH,
        _ if data.starts_with('{') => "JSON",
        _ if data.contains("t_s") => MOTION,
        _ if data.contains(',') => "a table of comma-separated values",
        _ => "some other text",
    };
    Some(kind)
}

#[cfg(test)]
mod tests {
    use super::not_a_scene;

    #[test]
    fn files_of_other_kinds_are_recognised() {
        let mut stl = vec![b' '; 84 + 50];
        stl[80..84].copy_from_slice(&1_u32.to_le_bytes());
        let cases: [(&[u8], &str); 11] = [
            (
                b"# made by hand\n\nt_s,x_m,y_m\n0,1,2\n",
                "like a trajectory,",
            ),
            (b"\xef\xbb\xbft_s,x_m\n", "like a trajectory,"),
            (b"1,2,3\n4,5,6\n", "comma-separated values,"),
            (b"# Blender\nmtllib a.mtl\nv 0 0 0\n", "like a mesh,"),
            (b"v 0 0 0\nv 1 0 0\n", "like a mesh,"),
            (b"solid cube\nfacet normal 0 0 1\n", "like a mesh,"),
            (b"{\n \"asset\": {\"version\": \"2.0\"}}", "like a mesh,"),
            (b"glTF\x02\0\0\0", "like a mesh,"),
            (&stl, "like a mesh,"),
            (b"\x89PNG\r\n\x1a\n\0\0", "like binary data,"),
            (b" \n", "empty"),
        ];
        for (bytes, part) in cases {
            let message = not_a_scene(bytes).unwrap();
            assert!(message.contains(part), "{message}");
            assert!(message.ends_with("a scene is a RON text beginning with `(`"));
        }
    }

    #[test]
    fn scenes_with_faults_are_left_to_the_reader() {
        let texts = [
            "(tool: )",
            "// a\n\n/* b */ (",
            "#![enable(implicit_some)]\n(",
            "Scene (",
            "Scene",
            "(v 0 0 0",
        ];
        for text in texts {
            assert_eq!(not_a_scene(text.as_bytes()), None, "{text}");
        }
        assert_eq!(not_a_scene(b"(\n a\xff"), None);
    }
}
