//! The types that generated stages are made of: what the engine needs to know to run a stage, and nothing more.
//!
//! Resources appear here as opaque handles; the `engine` crate makes them. This crate knows no Vulkan.

use std::marker::PhantomData;

/// Identifies a buffer or image for barrier derivation. Unique within one engine device, never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ResourceId(pub u32);

/// A range of a GPU buffer that holds elements of `T`, as a stage binds it.
#[derive(Debug)]
pub struct BufferRef<T> {
    /// The buffer, for barriers.
    pub id: ResourceId,
    /// The driver's handle.
    pub raw: u64,
    /// First byte of the range.
    pub offset: u64,
    /// Length of the range in bytes, > 0.
    pub size: u64,
    /// The element type, as the shader declares it.
    pub element: PhantomData<fn() -> T>,
}

impl<T> Clone for BufferRef<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for BufferRef<T> {}

impl<T> BufferRef<T> {
    /// The part of the range from element `first` on. `first` is less than the range's elements.
    pub fn from(self, first: usize) -> Self {
        let skipped = (first * size_of::<T>()) as u64;
        BufferRef { offset: self.offset + skipped, size: self.size - skipped, ..self }
    }
}

/// An image as a stage binds it: one view, always in the general layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageRef {
    /// The image, for barriers.
    pub id: ResourceId,
    /// The driver's handle of the view.
    pub view: u64,
    /// The driver's handle of the image itself, for copies.
    pub image: u64,
}

/// What a stage does with a binding, from its `readonly` and `writeonly` qualifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Only read.
    Read,
    /// Only written.
    Write,
    /// Read and written.
    ReadWrite,
}

/// What a binding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// A storage buffer.
    StorageBuffer,
    /// A texture without a sampler, read with `texelFetch`.
    SampledImage,
    /// A texture with the engine's one sampler (nearest, clamped to the edge), read with `textureGather`: four texels at once.
    GatheredImage,
    /// An image read or written with `imageLoad`, `imageStore` or image atomics.
    StorageImage,
}

/// One binding of descriptor set 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BindingInfo {
    /// The GLSL name.
    pub name: &'static str,
    /// The binding number.
    pub binding: u32,
    /// What it is.
    pub kind: BindingKind,
    /// What the stage does with it.
    pub access: Access,
}

/// Which pipeline stage a module is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShaderKind {
    /// A vertex shader (`.vert`).
    Vertex,
    /// A fragment shader (`.frag`).
    Fragment,
    /// A compute shader (`.comp`).
    Compute,
}

/// One compiled shader.
#[derive(Clone, Copy, Debug)]
pub struct ShaderModule {
    /// Which pipeline stage it is for.
    pub kind: ShaderKind,
    /// SPIR-V, little-endian words as bytes.
    pub spirv: &'static [u8],
}

/// How a vertex attribute lies in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexFormat {
    /// One `f32`.
    Float,
    /// Two `f32`.
    Float2,
    /// Three `f32`.
    Float3,
    /// Four `f32`.
    Float4,
    /// Two `i16`, -32767..=32767 standing for -1..=1.
    Snorm16x2,
    /// One `u32`.
    Uint,
}

/// One attribute of the interleaved vertex buffer, or of the interleaved instance buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VertexAttribute {
    /// The GLSL name.
    pub name: &'static str,
    /// The input location.
    pub location: u32,
    /// How it lies in memory.
    pub format: VertexFormat,
    /// Bytes from the start of the vertex or instance.
    pub offset: u32,
}

/// One specialization constant: 32 bits wide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConstantInfo {
    /// The GLSL name.
    pub name: &'static str,
    /// The `constant_id`.
    pub id: u32,
}

/// Everything that is fixed about a stage.
#[derive(Clone, Copy, Debug)]
pub struct StageInfo {
    /// The stage's name, its shader's path: debug label, timer row, results column.
    pub name: &'static str,
    /// One compute module, or a vertex and a fragment module.
    pub modules: &'static [ShaderModule],
    /// The bindings of set 0, by binding number.
    pub bindings: &'static [BindingInfo],
    /// Bytes of push constants, 0 for none; always from offset 0.
    pub push_size: u32,
    /// Specialization constants, in the order in which the stage gives their values.
    pub constants: &'static [ConstantInfo],
    /// Work-group size of a compute stage; zeros for a pipeline.
    pub local_size: [u32; 3],
    /// Vertex attributes of a pipeline, by location.
    pub vertex: &'static [VertexAttribute],
    /// Bytes of one vertex; 0 if the pipeline takes none.
    pub vertex_stride: u32,
    /// Attributes that go on once an instance, by location: GLSL inputs named `instance_…`, without that.
    pub instance: &'static [VertexAttribute],
    /// Bytes of one instance; 0 if the pipeline takes none.
    pub instance_stride: u32,
    /// Locations that the fragment shader writes, ascending.
    pub outputs: &'static [u32],
}

/// A resource given to a binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// A buffer range.
    Buffer {
        /// The buffer, for barriers.
        id: ResourceId,
        /// The driver's handle.
        raw: u64,
        /// First byte.
        offset: u64,
        /// Length in bytes.
        size: u64,
    },
    /// An image view.
    Image(ImageRef),
}

impl<T> From<BufferRef<T>> for Bound {
    fn from(buffer: BufferRef<T>) -> Self {
        Bound::Buffer { id: buffer.id, raw: buffer.raw, offset: buffer.offset, size: buffer.size }
    }
}

impl From<ImageRef> for Bound {
    fn from(image: ImageRef) -> Self {
        Bound::Image(image)
    }
}

/// The push constant bytes that every Vulkan device has room for.
pub const MAX_PUSH_BYTES: usize = 128;

/// A stage made ready to record: its resources and values, detached from the struct that named them.
#[derive(Clone, Debug)]
pub struct BoundStage {
    /// What is fixed about it.
    pub info: &'static StageInfo,
    /// One resource a binding, in the order of `info.bindings`.
    pub resources: Vec<Bound>,
    /// Push constants; `info.push_size` bytes count.
    pub push: [u8; MAX_PUSH_BYTES],
    /// Values of the specialization constants as raw bits, in the order of `info.constants`.
    pub constants: Vec<u32>,
}

impl BoundStage {
    /// Joins what a generated stage gives. `push` is at most [`MAX_PUSH_BYTES`] long.
    pub fn new(info: &'static StageInfo, resources: Vec<Bound>, push: &[u8], constants: Vec<u32>) -> Self {
        let mut bytes = [0; MAX_PUSH_BYTES];
        bytes[..push.len()].copy_from_slice(push);
        BoundStage { info, resources, push: bytes, constants }
    }
}

/// A generated stage: one struct a shader or pipeline, one field a binding, push constant and group of constants.
pub trait Stage {
    /// What is fixed about it.
    const INFO: &'static StageInfo;
    /// Its resources and values.
    fn bind(&self) -> BoundStage;
}

/// A stage that is dispatched.
pub trait ComputeStage: Stage {}

/// A vertex and a fragment shader that are drawn with.
pub trait GraphicsStage: Stage {}
