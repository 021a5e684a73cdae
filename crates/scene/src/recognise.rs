//! What a file that is no scene looks like: a trajectory, a mesh and a picture are easily named in a scene's place.

/// What a file is that is no scene, and the byte that tells; `None` where it may be a scene with a fault.
///
/// A scene begins with `(`, with an attribute `#![…]` or with its name, `Scene`, after blanks and comments.
pub(crate) fn not_a_scene(bytes: &[u8]) -> Option<(usize, String)> {
    let as_scene = "a scene is a RON text beginning with `(`";
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Some((0, format!("the file is empty; {as_scene}")));
    }
    let text = str::from_utf8(bytes).ok();
    let control = bytes.iter().position(|&byte| is_control(byte));
    let (at, kind) = match (binary(bytes), text.and_then(textual), control) {
        (Some(kind), _, _) => (0, kind),
        // A stray byte in what begins like a scene is told where it stands.
        (None, None, Some(at)) if text.is_some() => {
            let byte = bytes[at];
            let message = "has no place in a text; remove it";
            return Some((at, format!("a control character (byte {byte}) {message}")));
        }
        (None, _, Some(_)) if !is_utf_16(bytes) => (0, "binary data"),
        (None, other, _) => other?,
    };
    Some((
        at,
        format!("this looks like {kind}, not a scene; {as_scene}"),
    ))
}

/// Bytes that text in ASCII or UTF-8 does not have.
fn is_control(byte: u8) -> bool {
    matches!(byte, 0..=8 | 14..=31)
}

/// Text in UTF-16 is full of zeros; what to do about it is said where the encoding is checked.
fn is_utf_16(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff")
}

const MESH: &str = "a mesh";
const MOTION: &str = "a trajectory";

/// Meshes of bytes.
fn binary(bytes: &[u8]) -> Option<&'static str> {
    if bytes.starts_with(b"glTF") {
        return Some(MESH);
    }
    // The number of triangles of an STL file and its length agree.
    let count = bytes.get(80..84)?;
    let count = u64::from(u32::from_le_bytes([count[0], count[1], count[2], count[3]]));
    (bytes.len() as u64 == 84 + 50 * count).then_some(MESH)
}

/// What a text that does not begin like a scene begins like, and the offset of its first line that is no comment.
fn textual(text: &str) -> Option<(usize, &'static str)> {
    let is_told = |line: &&str| !line.is_empty() && !line.starts_with("//");
    let lines = text.lines().map(str::trim).filter(is_told);
    let first = lines.clone().next()?;
    if first.starts_with('(') || first.starts_with("#![") || first.starts_with("/*") {
        return None;
    }
    if let Some(rest) = first.strip_prefix("Scene")
        && rest.trim_start().chars().next().is_none_or(|c| c == '(')
    {
        return None;
    }
    // Both kinds of files have comments that begin with `#`.
    let data = lines.clone().find(|line| !line.starts_with('#'));
    let data = data.unwrap_or(first);
    let word = data.split_whitespace().next().unwrap_or(data);
    let kind = match word {
        "v" | "vn" | "vt" | "f" | "o" | "g" | "s" | "mtllib" | "usemtl" | "solid" => MESH,
        _ if data.starts_with('{') && text.contains("\"asset\"") => MESH,
        _ if data.starts_with('{') => "JSON",
        _ if data.contains("t_s") => MOTION,
        _ if data.contains(',') && !data.contains([':', '(', '[']) => {
            "a table of comma-separated values"
        }
        _ => "some other text",
    };
    let at = first.as_ptr().addr() - text.as_ptr().addr();
    Some((at, kind))
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
            let (_, message) = not_a_scene(bytes).unwrap();
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
