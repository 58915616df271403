use super::buffers::Buffers;
use gltf_json::accessor::{Accessor, ComponentType, Type};
use gltf_json::validation::Checked;
use gltf_json::{Index, Root};

/// The elements of an accessor. Every access stays within its buffer.
pub(super) struct Elements<'a> {
    component: ComponentType,
    normalized: bool,
    pub(super) count: usize,
    /// `None` stands for zeros.
    base: Option<Strided<'a>>,
    /// The indices of the elements that are replaced, ascending.
    replaced: Vec<u32>,
    replacements: Option<Strided<'a>>,
}

/// Elements at a constant distance (stride).
#[derive(Clone, Copy)]
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
}

impl<'a> Strided<'a> {
    /// Checks that `count` elements of `size` bytes from `offset` on are within the bytes.
    fn new(bytes: &'a [u8], offset: u64, stride: usize, size: usize, count: usize) -> Option<Self> {
        let bytes = bytes.get(usize::try_from(offset).ok()?..)?;
        let last = count
            .checked_sub(1)
            .map_or(Some(0), |n| n.checked_mul(stride)?.checked_add(size))?;
        (last <= bytes.len()).then_some(Self { bytes, stride })
    }

    fn at(&self, index: usize) -> &'a [u8] {
        self.bytes.get(index * self.stride..).unwrap_or_default()
    }
}

fn size(component: ComponentType) -> usize {
    match component {
        ComponentType::I8 | ComponentType::U8 => 1,
        ComponentType::I16 | ComponentType::U16 => 2,
        ComponentType::U32 | ComponentType::F32 => 4,
    }
}

/// A component as a number; normalised integers are scaled to `0..=1` or `-1..=1`.
fn component(bytes: &[u8], kind: ComponentType, normalized: bool) -> f64 {
    fn first<const N: usize>(bytes: &[u8]) -> [u8; N] {
        bytes.first_chunk().copied().unwrap_or([0; N])
    }
    let (value, most) = match kind {
        ComponentType::I8 => (f64::from(i8::from_le_bytes(first(bytes))), 127.0),
        ComponentType::U8 => (f64::from(u8::from_le_bytes(first(bytes))), 255.0),
        ComponentType::I16 => (f64::from(i16::from_le_bytes(first(bytes))), 32767.0),
        ComponentType::U16 => (f64::from(u16::from_le_bytes(first(bytes))), 65535.0),
        ComponentType::U32 => (f64::from(u32::from_le_bytes(first(bytes))), 4_294_967_295.0),
        ComponentType::F32 => return f64::from(f32::from_le_bytes(first(bytes))),
    };
    if !normalized {
        return value;
    }
    // The smallest signed value counts as -1, like the next one.
    let scaled = value / most;
    if scaled < -1.0 { -1.0 } else { scaled }
}

impl<'a> Elements<'a> {
    /// The elements of an accessor, which must be of this type.
    pub(super) fn new(
        root: &Root,
        buffers: &'a Buffers<'_>,
        index: Index<Accessor>,
        expected: Type,
    ) -> Result<Self, String> {
        let i = index.value();
        let accessor = root
            .accessors
            .get(i)
            .ok_or_else(|| format!("there is no accessor {i}"))?;
        let (Checked::Valid(kind), Checked::Valid(found)) =
            (&accessor.component_type, &accessor.type_)
        else {
            return Err(format!("accessor {i} has no valid type"));
        };
        if *found != expected {
            return Err(format!(
                "accessor {i} should be of type {expected:?}, but is of type {found:?}"
            ));
        }
        let component = kind.0;
        let size = size(component) * found.multiplicity();
        let count = usize::try_from(accessor.count.0)
            .map_err(|_| format!("accessor {i} has too many elements"))?;
        let outside = || format!("accessor {i} reaches beyond its buffer view");
        let base = match accessor.buffer_view {
            Some(view) => {
                let (bytes, stride) = buffers.view(view)?;
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                Some(
                    Strided::new(bytes, offset, stride.unwrap_or(size), size, count)
                        .ok_or_else(outside)?,
                )
            }
            None => None,
        };
        let mut elements = Self {
            component,
            normalized: accessor.normalized,
            count,
            base,
            replaced: vec![],
            replacements: None,
        };
        if let Some(sparse) = &accessor.sparse {
            let Checked::Valid(kind) = &sparse.indices.component_type else {
                return Err(format!("accessor {i} has no valid type of sparse indices"));
            };
            let replaced = usize::try_from(sparse.count.0).map_err(|_| outside())?;
            let (bytes, _) = buffers.view(sparse.indices.buffer_view)?;
            let width = self::size(kind.0);
            let numbers = Strided::new(bytes, sparse.indices.byte_offset.0, width, width, replaced)
                .ok_or_else(outside)?;
            elements.replaced = (0..replaced)
                .map(|k| self::component(numbers.at(k), kind.0, false) as u32)
                .collect();
            if !elements.replaced.is_sorted() {
                return Err(format!("the sparse indices of accessor {i} don't ascend"));
            }
            let (bytes, _) = buffers.view(sparse.values.buffer_view)?;
            let values = Strided::new(bytes, sparse.values.byte_offset.0, size, size, replaced)
                .ok_or_else(outside)?;
            elements.replacements = Some(values);
        }
        Ok(elements)
    }

    /// The bytes of an element.
    fn bytes(&self, index: usize) -> &'a [u8] {
        if let Some(values) = &self.replacements
            && let Ok(k) = self
                .replaced
                .binary_search_by(|n| (*n as usize).cmp(&index))
        {
            return values.at(k);
        }
        self.base.as_ref().map_or(&[], |base| base.at(index))
    }

    /// The components of an element below `count`.
    pub(super) fn get<const N: usize>(&self, index: usize) -> [f64; N] {
        let (bytes, size) = (self.bytes(index), size(self.component));
        std::array::from_fn(|k| {
            component(
                bytes.get(k * size..).unwrap_or_default(),
                self.component,
                self.normalized,
            )
        })
    }

    /// An index, from an accessor of unsigned integers.
    pub(super) fn integer(&self, index: usize) -> u32 {
        component(self.bytes(index), self.component, false) as u32
    }

    /// Whether the components are unsigned integers, as indices must be.
    pub(super) fn can_be_indices(&self) -> bool {
        matches!(
            self.component,
            ComponentType::U8 | ComponentType::U16 | ComponentType::U32
        )
    }
}
