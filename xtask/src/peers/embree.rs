//! Embree 3 through its C API, loaded at run time: nothing is linked, and if the library is missing the benchmark reports it.
#![expect(
    unsafe_code,
    reason = "calls of a C library; every block says why it is sound"
)]

mod tree;

use super::rays::Segment;
use anyhow::{Context, Result, bail};
use libloading::Library;
use std::ffi::{c_char, c_uint, c_void};
use std::ptr;
use tree::Arguments;

/// `struct RTCRayHit`: a ray and its hit.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
pub(super) struct RayHit {
    origin: [f32; 3],
    near: f32,
    direction: [f32; 3],
    time: f32,
    far: f32,
    mask: u32,
    id: u32,
    flags: u32,
    normal: [f32; 3],
    uv: [f32; 2],
    primitive: u32,
    geometry: u32,
    instance: u32,
}

/// `struct RTCRayHit16`: sixteen rays and their hits, side by side.
#[repr(C, align(64))]
#[derive(Clone, Copy)]
pub(super) struct RayHit16 {
    origin: [[f32; 16]; 3],
    near: [f32; 16],
    direction: [[f32; 16]; 3],
    time: [f32; 16],
    far: [f32; 16],
    mask: [u32; 16],
    id: [u32; 16],
    flags: [u32; 16],
    normal: [[f32; 16]; 3],
    uv: [[f32; 16]; 2],
    primitive: [u32; 16],
    geometry: [u32; 16],
    instance: [u32; 16],
}

/// `struct RTCIntersectContext`.
#[repr(C)]
struct Context1 {
    flags: c_uint,
    filter: *const c_void,
    instance: c_uint,
}

const INVALID: u32 = u32::MAX;
const TRIANGLES: c_uint = 0;
const SPHERES: c_uint = 50;
const INDEX_BUFFER: c_uint = 0;
const VERTEX_BUFFER: c_uint = 1;
const UINT3: c_uint = 0x5003;
const FLOAT3: c_uint = 0x9003;
const FLOAT4: c_uint = 0x9004;
const ROBUST: c_uint = 1 << 2;

/// The quality of Embree's builds.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Quality {
    Medium = 1,
    High = 2,
}

type Handle = *mut c_void;

/// The library with the functions used here.
pub(super) struct Embree {
    new_device: unsafe extern "C" fn(*const c_char) -> Handle,
    release_device: unsafe extern "C" fn(Handle),
    new_scene: unsafe extern "C" fn(Handle) -> Handle,
    release_scene: unsafe extern "C" fn(Handle),
    set_quality: unsafe extern "C" fn(Handle, c_uint),
    set_flags: unsafe extern "C" fn(Handle, c_uint),
    commit_scene: unsafe extern "C" fn(Handle),
    new_geometry: unsafe extern "C" fn(Handle, c_uint) -> Handle,
    new_buffer: unsafe extern "C" fn(Handle, c_uint, c_uint, c_uint, usize, usize) -> *mut c_void,
    commit_geometry: unsafe extern "C" fn(Handle),
    release_geometry: unsafe extern "C" fn(Handle),
    attach: unsafe extern "C" fn(Handle, Handle) -> c_uint,
    intersect1: unsafe extern "C" fn(Handle, *mut Context1, *mut RayHit),
    occluded1: unsafe extern "C" fn(Handle, *mut Context1, *mut RayHit),
    intersect16: unsafe extern "C" fn(*const i32, Handle, *mut Context1, *mut RayHit16),
    occluded16: unsafe extern "C" fn(*const i32, Handle, *mut Context1, *mut RayHit16),
    new_bvh: unsafe extern "C" fn(Handle) -> Handle,
    build_bvh: unsafe extern "C" fn(*const Arguments<'_>) -> Handle,
    release_bvh: unsafe extern "C" fn(Handle),
    /// Keeps the functions valid. It is never unloaded, because its threads may still run at the end.
    _library: &'static Library,
}

impl Embree {
    /// Finds the library of Debian's package libembree3 (or libembree-dev).
    pub(super) fn load() -> Result<Self> {
        // SAFETY: Embree's initialisers have no preconditions.
        let library = unsafe { Library::new("libembree3.so.3") }
            .context("Embree 3 is missing: install Debian's package libembree-dev")?;
        let library: &'static Library = Box::leak(Box::new(library));
        /// Looks a function up.
        ///
        /// # Safety
        /// `T` must be the C type of the function.
        unsafe fn symbol<T: Copy>(library: &Library, name: &str) -> Result<T> {
            // SAFETY: promised by the caller.
            let found = unsafe { library.get::<T>(name.as_bytes()) };
            Ok(*found.with_context(|| format!("this Embree has no {name}"))?)
        }
        // SAFETY: the types of the fields are those of Embree 3's headers.
        unsafe {
            Ok(Self {
                new_device: symbol(library, "rtcNewDevice")?,
                release_device: symbol(library, "rtcReleaseDevice")?,
                new_scene: symbol(library, "rtcNewScene")?,
                release_scene: symbol(library, "rtcReleaseScene")?,
                set_quality: symbol(library, "rtcSetSceneBuildQuality")?,
                set_flags: symbol(library, "rtcSetSceneFlags")?,
                commit_scene: symbol(library, "rtcCommitScene")?,
                new_geometry: symbol(library, "rtcNewGeometry")?,
                new_buffer: symbol(library, "rtcSetNewGeometryBuffer")?,
                commit_geometry: symbol(library, "rtcCommitGeometry")?,
                release_geometry: symbol(library, "rtcReleaseGeometry")?,
                attach: symbol(library, "rtcAttachGeometry")?,
                intersect1: symbol(library, "rtcIntersect1")?,
                occluded1: symbol(library, "rtcOccluded1")?,
                intersect16: symbol(library, "rtcIntersect16")?,
                occluded16: symbol(library, "rtcOccluded16")?,
                new_bvh: symbol(library, "rtcNewBVH")?,
                build_bvh: symbol(library, "rtcBuildBVH")?,
                release_bvh: symbol(library, "rtcReleaseBVH")?,
                _library: library,
            })
        }
    }

    /// A device with threads of its own to build with. Making one takes milliseconds, which are no part of building.
    pub(super) fn device(&self, threads: usize) -> Result<Device<'_>> {
        let config = format!("threads={threads}\0");
        // SAFETY: the text ends in zero.
        let handle = unsafe { (self.new_device)(config.as_ptr().cast()) };
        if handle.is_null() {
            bail!("Embree returned no device");
        }
        Ok(Device {
            embree: self,
            handle,
        })
    }
}

/// A device of Embree, which owns scenes.
pub(super) struct Device<'e> {
    embree: &'e Embree,
    handle: Handle,
}

impl Drop for Device<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle came from the library and is released only here; the scenes of the device borrow it.
        unsafe { (self.embree.release_device)(self.handle) };
    }
}

impl Device<'_> {
    /// A scene of triangles; building it takes the time this call takes.
    pub(super) fn triangles(
        &self,
        positions: &[[f32; 3]],
        indices: &[[u32; 3]],
        options: Options,
    ) -> Result<EmbreeScene<'_>> {
        self.scene(TRIANGLES, options, |geometry| {
            self.fill(geometry, VERTEX_BUFFER, FLOAT3, positions)?;
            self.fill(geometry, INDEX_BUFFER, UINT3, indices)
        })
    }

    /// A scene of spheres (centre and radius).
    pub(super) fn spheres(
        &self,
        spheres: &[[f32; 4]],
        options: Options,
    ) -> Result<EmbreeScene<'_>> {
        self.scene(SPHERES, options, |geometry| {
            self.fill(geometry, VERTEX_BUFFER, FLOAT4, spheres)
        })
    }

    fn scene(
        &self,
        kind: c_uint,
        options: Options,
        fill: impl FnOnce(Handle) -> Result<()>,
    ) -> Result<EmbreeScene<'_>> {
        let embree = self.embree;
        // SAFETY: handles are used in the order the API asks for; the scene's is released once, by `Drop`.
        unsafe {
            let scene = (embree.new_scene)(self.handle);
            let held = EmbreeScene { embree, scene };
            (embree.set_quality)(scene, options.quality as c_uint);
            (embree.set_flags)(scene, if options.robust { ROBUST } else { 0 });
            let geometry = (embree.new_geometry)(self.handle, kind);
            let filled = fill(geometry);
            if filled.is_ok() {
                (embree.commit_geometry)(geometry);
                (embree.attach)(scene, geometry);
            }
            (embree.release_geometry)(geometry);
            filled?;
            (embree.commit_scene)(scene);
            Ok(held)
        }
    }

    /// Copies items into a new buffer of a geometry.
    fn fill<T: Copy>(
        &self,
        geometry: Handle,
        buffer: c_uint,
        format: c_uint,
        items: &[T],
    ) -> Result<()> {
        let new_buffer = self.embree.new_buffer;
        // SAFETY: Embree's buffers hold `len` items of `size` bytes, aligned to 16, and 16 bytes more.
        unsafe {
            let to = new_buffer(geometry, buffer, 0, format, size_of::<T>(), items.len());
            if to.is_null() {
                bail!("Embree returned no memory");
            }
            ptr::copy_nonoverlapping(items.as_ptr(), to.cast(), items.len());
        }
        Ok(())
    }
}

/// How to build a scene.
#[derive(Clone, Copy)]
pub(super) struct Options {
    pub(super) quality: Quality,
    pub(super) robust: bool,
}

/// A built scene.
pub(super) struct EmbreeScene<'e> {
    embree: &'e Embree,
    scene: Handle,
}

impl Drop for EmbreeScene<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle came from the library and is released only here.
        unsafe { (self.embree.release_scene)(self.scene) };
    }
}

// SAFETY: Embree's queries on a committed scene may be made from any thread.
unsafe impl Sync for EmbreeScene<'_> {}

impl RayHit {
    fn new(ray: &Segment) -> Self {
        Self {
            origin: ray.origin,
            near: ray.near,
            direction: ray.direction,
            time: 0.0,
            far: ray.far,
            mask: INVALID,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            uv: [0.0; 2],
            primitive: INVALID,
            geometry: INVALID,
            instance: INVALID,
        }
    }
}

impl RayHit16 {
    /// Packs up to sixteen rays; the remaining lanes are zero.
    pub(super) fn of(rays: &[Segment]) -> Self {
        let mut packet = Self {
            origin: [[0.0; 16]; 3],
            near: [0.0; 16],
            direction: [[0.0; 16]; 3],
            time: [0.0; 16],
            far: [0.0; 16],
            mask: [INVALID; 16],
            id: [0; 16],
            flags: [0; 16],
            normal: [[0.0; 16]; 3],
            uv: [[0.0; 16]; 2],
            primitive: [INVALID; 16],
            geometry: [INVALID; 16],
            instance: [INVALID; 16],
        };
        for (lane, ray) in rays.iter().enumerate().take(16) {
            for axis in 0..3 {
                packet.origin[axis][lane] = ray.origin[axis];
                packet.direction[axis][lane] = ray.direction[axis];
            }
            packet.near[lane] = ray.near;
            packet.far[lane] = ray.far;
        }
        packet
    }
}

impl Context1 {
    fn new(coherent: bool) -> Self {
        Self {
            flags: u32::from(coherent),
            filter: ptr::null(),
            instance: INVALID,
        }
    }
}

impl EmbreeScene<'_> {
    /// Appends the distances of the closest hits of all rays in order; infinite if there is none.
    pub(super) fn closest(&self, rays: &[Segment], out: &mut Vec<f32>) {
        let mut context = Context1::new(false);
        out.clear();
        for ray in rays {
            let mut query = RayHit::new(ray);
            // SAFETY: the scene is committed; both structures have the layout of Embree's headers.
            unsafe { (self.embree.intersect1)(self.scene, &mut context, &mut query) };
            out.push(if query.geometry == INVALID {
                f32::INFINITY
            } else {
                query.far
            });
        }
    }

    /// The number of rays that hit anything.
    pub(super) fn occluded(&self, rays: &[Segment]) -> usize {
        let mut context = Context1::new(false);
        let mut hits = 0;
        for ray in rays {
            let mut query = RayHit::new(ray);
            // SAFETY: as above; the hit part is not used by this function.
            unsafe { (self.embree.occluded1)(self.scene, &mut context, &mut query) };
            hits += usize::from(query.far < 0.0);
        }
        hits
    }

    /// Traces packets of sixteen rays, for any hit or for the closest one; returns the number of hits.
    pub(super) fn packets(&self, packets: &[RayHit16], any: bool) -> usize {
        let mut context = Context1::new(true);
        let valid = Valid([-1; 16]);
        let mut hits = 0;
        for packet in packets {
            let mut query = *packet;
            let function = if any {
                self.embree.occluded16
            } else {
                self.embree.intersect16
            };
            // SAFETY: the scene is committed; the structures have the layout and alignment of Embree's headers.
            unsafe { function(valid.0.as_ptr(), self.scene, &mut context, &mut query) };
            hits += (0..16)
                .filter(|i| {
                    if any {
                        query.far[*i] < 0.0
                    } else {
                        query.geometry[*i] != INVALID
                    }
                })
                .count();
        }
        hits
    }
}

/// The mask of the lanes of a packet that are in use.
#[repr(align(64))]
struct Valid([i32; 16]);
