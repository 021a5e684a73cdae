//! glTF documents with a few fields out of order.

use arbitrary::Arbitrary;

/// A model of one mesh, its nodes and its bytes.
#[derive(Arbitrary, Debug)]
pub struct Document {
    positions: Vec<[Number; 3]>,
    indices: Vec<u16>,
    wide_indices: bool,
    indexed: bool,
    mode: Option<u8>,
    nodes: Vec<Node>,
    roots: Vec<u8>,
    required: Option<Extension>,
    mutations: Vec<Mutation>,
    extra_bytes: Vec<u8>,
    stated_length: Option<i8>,
}

/// A coordinate: mostly small and whole, sometimes any bits.
#[derive(Arbitrary, Clone, Copy, Debug)]
enum Number {
    Small(i8),
    Half(i8),
    Bits(u32),
}

#[derive(Arbitrary, Debug)]
struct Node {
    has_mesh: bool,
    placement: Placement,
    children: Vec<u8>,
}

#[derive(Arbitrary, Debug)]
enum Placement {
    None,
    Matrix([Number; 16]),
    Parts {
        translation: [Number; 3],
        rotation: [i8; 4],
        scale: [Number; 3],
    },
}

#[derive(Arbitrary, Debug)]
enum Extension {
    Draco,
    Meshopt,
    Quantization,
    Unknown,
}

/// A field given another value.
#[derive(Arbitrary, Debug)]
enum Mutation {
    Count(bool, Size),
    ComponentType(bool, u16),
    AccessorOffset(bool, Size),
    View(bool, Option<u8>),
    ViewOffset(bool, Size),
    ViewLength(bool, Size),
    Stride(bool, Size),
    Buffer(bool, u8),
    Kind(bool, u8),
    BufferLength(Size),
    Normalized(bool),
    Sparse(bool, Size, u8, u8),
    Bounds,
    Version(u8),
}

/// A length: near the right one, or any.
#[derive(Arbitrary, Clone, Copy, Debug)]
enum Size {
    Small(u8),
    Any(u64),
    Near(i8),
}

/// Accessor and view of one attribute.
#[derive(Clone, Debug)]
struct Part {
    count: u64,
    component: u16,
    accessor_offset: Option<u64>,
    view: Option<u8>,
    view_offset: u64,
    view_length: u64,
    stride: Option<u64>,
    buffer: u8,
    kind: u8,
    more: String,
}

const KINDS: [&str; 8] = [
    "VEC3", "SCALAR", "VEC2", "VEC4", "MAT2", "MAT3", "MAT4", "VEC9",
];

const EXTENSIONS: [&str; 4] = [
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_mesh_quantization",
    "EXT_of_tomorrow",
];

impl Document {
    /// The document as the bytes of a GLB file.
    pub fn glb(&self) -> Vec<u8> {
        let binary = self.binary();
        let mut json = self.json(binary.len() as u64).into_bytes();
        while json.len() % 4 != 0 {
            json.push(b' ');
        }
        let length = 12 + 8 + json.len() + 8 + binary.len();
        let stated = (length as u32).wrapping_add_signed(self.stated_length.unwrap_or(0).into());
        let mut glb = b"glTF\x02\0\0\0".to_vec();
        glb.extend(stated.to_le_bytes());
        glb.extend((json.len() as u32).to_le_bytes());
        glb.extend(b"JSON");
        glb.extend(json);
        glb.extend((binary.len() as u32).to_le_bytes());
        glb.extend(b"BIN\0");
        glb.extend(binary);
        glb
    }

    fn binary(&self) -> Vec<u8> {
        let coordinates = self.positions.iter().flatten();
        let mut binary: Vec<u8> = coordinates.flat_map(|n| n.get().to_le_bytes()).collect();
        for &index in &self.indices {
            // Near the number of positions, so that most are in range.
            let index = index % (self.positions.len() as u16 + 1).max(1);
            if self.wide_indices {
                binary.extend(u32::from(index).to_le_bytes());
            } else {
                binary.extend(index.to_le_bytes());
            }
        }
        binary.extend(&self.extra_bytes);
        while binary.len() % 4 != 0 {
            binary.push(0);
        }
        binary
    }

    fn parts(&self) -> [Part; 2] {
        let bytes = 12 * self.positions.len() as u64;
        let (component, width) = if self.wide_indices {
            (5125, 4)
        } else {
            (5123, 2)
        };
        let plain = |view, count, component, offset, length, kind| Part {
            count,
            component,
            accessor_offset: None,
            view: Some(view),
            view_offset: offset,
            view_length: length,
            stride: None,
            buffer: 0,
            kind,
            more: String::new(),
        };
        let indices = self.indices.len() as u64;
        let mut parts = [
            plain(0, self.positions.len() as u64, 5126, 0, bytes, 0),
            plain(1, indices, component, bytes, width * indices, 1),
        ];
        for mutation in &self.mutations {
            mutate(&mut parts, mutation);
        }
        parts
    }

    fn json(&self, binary: u64) -> String {
        let parts = self.parts();
        let accessors = parts.each_ref().map(Part::accessor).join(",");
        let views = parts.each_ref().map(Part::view).join(",");
        let mut version = "2.0".to_owned();
        let mut length = binary;
        for mutation in &self.mutations {
            match mutation {
                Mutation::Version(major) => version = format!("{major}.0"),
                Mutation::BufferLength(size) => length = size.of(length),
                _ => {}
            }
        }
        let mode = self
            .mode
            .map_or_else(String::new, |mode| format!(r#","mode":{mode}"#));
        let indices = if self.indexed { r#","indices":1"# } else { "" };
        let nodes: Vec<String> = self.nodes.iter().map(Node::json).collect();
        let nodes = if nodes.is_empty() {
            r#"{"mesh":0}"#.to_owned()
        } else {
            nodes.join(",")
        };
        let roots = if self.roots.is_empty() {
            vec!["0".to_owned()]
        } else {
            self.roots.iter().map(u8::to_string).collect()
        };
        let required = self
            .required
            .as_ref()
            .map_or_else(String::new, |extension| {
                format!(r#","extensionsRequired":["{}"]"#, extension.name())
            });
        format!(
            r#"{{"asset":{{"version":"{version}"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{nodes}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}{indices}{mode}}}]}}],"accessors":[{accessors}],"bufferViews":[{views}],"buffers":[{{"byteLength":{length}}}]{required}}}"#,
            roots.join(","),
        )
    }
}

fn mutate(parts: &mut [Part; 2], mutation: &Mutation) {
    match *mutation {
        Mutation::Count(which, size) => {
            let part = &mut parts[usize::from(which)];
            part.count = size.of(part.count);
        }
        Mutation::ComponentType(which, component) => {
            let part = &mut parts[usize::from(which)];
            part.component = if component > 7 {
                component
            } else {
                5120 + component
            };
        }
        Mutation::AccessorOffset(which, size) => {
            parts[usize::from(which)].accessor_offset = Some(size.of(0));
        }
        Mutation::View(which, view) => parts[usize::from(which)].view = view,
        Mutation::ViewOffset(which, size) => {
            let part = &mut parts[usize::from(which)];
            part.view_offset = size.of(part.view_offset);
        }
        Mutation::ViewLength(which, size) => {
            let part = &mut parts[usize::from(which)];
            part.view_length = size.of(part.view_length);
        }
        Mutation::Stride(which, size) => parts[usize::from(which)].stride = Some(size.of(12)),
        Mutation::Buffer(which, buffer) => parts[usize::from(which)].buffer = buffer,
        Mutation::Kind(which, kind) => parts[usize::from(which)].kind = kind,
        Mutation::Normalized(which) => {
            parts[usize::from(which)]
                .more
                .push_str(r#","normalized":true"#);
        }
        Mutation::Sparse(which, size, indices, values) => {
            let sparse = format!(
                r#","sparse":{{"count":{},"indices":{{"bufferView":{indices},"componentType":5123}},"values":{{"bufferView":{values}}}}}"#,
                size.of(1)
            );
            parts[usize::from(which)].more.push_str(&sparse);
        }
        Mutation::Bounds => parts[0].more.push_str(r#","min":[0,0,0],"max":[1,1,1]"#),
        Mutation::BufferLength(_) | Mutation::Version(_) => {}
    }
}

impl Part {
    fn accessor(&self) -> String {
        let view = self
            .view
            .map_or_else(String::new, |view| format!(r#","bufferView":{view}"#));
        let offset = self
            .accessor_offset
            .map_or_else(String::new, |offset| format!(r#","byteOffset":{offset}"#));
        format!(
            r#"{{"componentType":{},"count":{},"type":"{}"{view}{offset}{}}}"#,
            self.component,
            self.count,
            KINDS[usize::from(self.kind) % KINDS.len()],
            self.more
        )
    }

    fn view(&self) -> String {
        let stride = self
            .stride
            .map_or_else(String::new, |stride| format!(r#","byteStride":{stride}"#));
        format!(
            r#"{{"buffer":{},"byteOffset":{},"byteLength":{}{stride}}}"#,
            self.buffer, self.view_offset, self.view_length
        )
    }
}

impl Node {
    fn json(&self) -> String {
        let mut fields = Vec::new();
        if self.has_mesh {
            fields.push(r#""mesh":0"#.to_owned());
        }
        if !self.children.is_empty() {
            let children: Vec<String> = self.children.iter().map(u8::to_string).collect();
            fields.push(format!(r#""children":[{}]"#, children.join(",")));
        }
        match &self.placement {
            Placement::None => {}
            Placement::Matrix(matrix) => fields.push(format!(r#""matrix":[{}]"#, list(matrix))),
            Placement::Parts {
                translation,
                rotation,
                scale,
            } => {
                let length = rotation
                    .iter()
                    .map(|&v| f64::from(v) * f64::from(v))
                    .sum::<f64>()
                    .sqrt();
                let rotation = rotation.map(|v| (f64::from(v) / length.max(1.0)).to_string());
                fields.push(format!(r#""translation":[{}]"#, list(translation)));
                fields.push(format!(r#""rotation":[{}]"#, rotation.join(",")));
                fields.push(format!(r#""scale":[{}]"#, list(scale)));
            }
        }
        format!("{{{}}}", fields.join(","))
    }
}

/// Numbers of JSON, which has no NaN.
fn list(numbers: &[Number]) -> String {
    let written: Vec<String> = numbers
        .iter()
        .map(|number| {
            let value = number.get();
            if value.is_finite() {
                format!("{value:?}")
            } else {
                "1e39".to_owned()
            }
        })
        .collect();
    written.join(",")
}

impl Number {
    fn get(self) -> f32 {
        match self {
            Self::Small(value) => value.into(),
            Self::Half(value) => f32::from(value) * 0.5,
            Self::Bits(bits) => f32::from_bits(bits),
        }
    }
}

impl Extension {
    const fn name(&self) -> &'static str {
        match self {
            Self::Draco => EXTENSIONS[0],
            Self::Meshopt => EXTENSIONS[1],
            Self::Quantization => EXTENSIONS[2],
            Self::Unknown => EXTENSIONS[3],
        }
    }
}

impl Size {
    fn of(self, right: u64) -> u64 {
        match self {
            Self::Small(size) => size.into(),
            Self::Any(size) => size,
            Self::Near(by) => right.wrapping_add_signed(by.into()),
        }
    }
}
