//! Uploads recordings to the graphics card, in single precision, so that the card computes vertex
//! positions by itself.
//!
//! Guaranteed: nothing waits for an upload, and the stage looks the same before and after it. If a
//! recording does not fit into the memory of the card, the CPU computes the vertices. Not
//! guaranteed: playback after the graphics device was lost and recreated; the program must then put
//! its transitions on the stage again.

use bevy::prelude::*;
use bevy::render::render_resource::{Buffer, BufferInitDescriptor, BufferUsages, DownlevelFlags};
use bevy::render::renderer::{RenderAdapter, RenderDevice};
use bevy::tasks::AsyncComputeTaskPool;
use bevy::tasks::futures::check_ready;
use glam::DVec2;
use wgpu::ErrorFilter;

use crate::recording::{Recording, SinglePrecisionInterval};

use super::components::Morph;
use super::paint::StagePaint;
use super::parts::StagePart;
use super::uploaded_recording::{UploadState, UploadedInterval, UploadedIntervals};

/// Number of storage buffers that Bevy itself binds in the vertex shaders of 2D meshes. A recording
/// needs one more.
const BEVY_STORAGE_BUFFERS: u32 = 3;

/// The graphics device to which recordings are uploaded. The resource exists only if its vertex
/// shaders can read one more storage buffer than Bevy needs.
#[derive(Resource, Clone)]
pub(super) struct RecordingGpu {
    device: RenderDevice,
    /// Buffer that is bound while no recording is uploaded.
    placeholder: Buffer,
    /// Maximum size of a buffer, and thus of an uploaded interval, in bytes.
    max_bytes: u64,
}

impl RecordingGpu {
    pub(super) fn placeholder(&self) -> &Buffer {
        &self.placeholder
    }
}

/// Inserts the resource [`RecordingGpu`] if the graphics card can evaluate recordings.
pub(super) fn detect_gpu(
    mut commands: Commands,
    device: Option<Res<RenderDevice>>,
    adapter: Option<Res<RenderAdapter>>,
) {
    let (Some(device), Some(adapter)) = (device, adapter) else {
        return;
    };
    let limits = device.limits();
    let flags = adapter.get_downlevel_capabilities().flags;
    if flags.contains(DownlevelFlags::VERTEX_STORAGE)
        && limits.max_storage_buffers_per_shader_stage > BEVY_STORAGE_BUFFERS
    {
        commands.insert_resource(RecordingGpu {
            placeholder: buffer(&device, &[[0.0; 2]]),
            max_bytes: limits
                .max_storage_buffer_binding_size
                .min(limits.max_buffer_size),
            device: device.clone(),
        });
    }
}

/// Creates a storage buffer with the given numbers.
fn buffer(device: &RenderDevice, numbers: &[[f32; 2]]) -> Buffer {
    device.create_buffer_with_data(&BufferInitDescriptor {
        label: Some("recording"),
        contents: bytemuck::cast_slice(numbers),
        usage: BufferUsages::STORAGE,
    })
}

/// Starts to upload the recording of each morph that has one and has not been uploaded yet.
pub(super) fn start_uploads(
    mut commands: Commands,
    gpu: Option<Res<RecordingGpu>>,
    morphs: Query<(Entity, &Morph, &Children), Without<UploadState>>,
    parts: Query<&StagePart>,
) {
    let Some(gpu) = gpu else {
        return;
    };
    for (entity, morph, children) in &morphs {
        let transition = morph.frame().transition();
        let mut parts = parts.iter_many(children);
        let played = parts.find(|part| matches!(part.paint, StagePaint::Recorded(_)));
        if let (Some(Ok(recording)), Some(part)) = (transition.recording(), played) {
            let (gpu, recording, origin) = (gpu.clone(), recording.clone(), part.origin);
            let vertices = morph.frame().placement().in_frame.len();
            let task = AsyncComputeTaskPool::get()
                .spawn(async move { gpu.upload(recording, vertices, origin).await });
            commands
                .entity(entity)
                .try_insert(UploadState::Uploading(task));
        }
    }
}

/// Replaces each [`UploadState::Uploading`] whose upload has ended by `Ready`, or by `Refused` if
/// the recording did not fit into the memory of the graphics card.
pub(super) fn finish_uploads(mut uploads: Query<&mut UploadState>) {
    for mut state in &mut uploads {
        if let UploadState::Uploading(task) = state.bypass_change_detection()
            && let Some(uploaded) = check_ready(task)
        {
            *state = uploaded.map_or(UploadState::Refused, UploadState::Ready);
        }
    }
}

impl RecordingGpu {
    /// Uploads all intervals of a recording; `None` if they do not fit into the memory of the
    /// graphics card. Positions are relative to `origin`.
    async fn upload(
        self,
        recording: Recording,
        vertices: usize,
        origin: DVec2,
    ) -> Option<UploadedIntervals> {
        let device = self.device.wgpu_device();
        // Without an error scope, the program would end if the card runs out of memory.
        let scope = device.push_error_scope(ErrorFilter::OutOfMemory);
        let intervals = recording.single_precision_intervals(vertices, origin);
        let uploaded: Option<Vec<UploadedInterval>> = intervals
            .map(|single| self.upload_interval(&single))
            .collect();
        let error = scope.pop().await;
        let uploaded = uploaded.filter(|uploaded| error.is_none() && !uploaded.is_empty())?;
        Some(UploadedIntervals {
            recording,
            intervals: uploaded,
        })
    }

    /// Uploads one interval of a recording; `None` if it is larger than `max_bytes`.
    fn upload_interval(&self, single: &SinglePrecisionInterval) -> Option<UploadedInterval> {
        let bytes = size_of_val(&single.numbers[..]) as u64;
        (bytes <= self.max_bytes).then(|| UploadedInterval {
            rows: buffer(&self.device, &single.numbers),
            vertices: single.vertices,
            coefficients: single.coefficients,
        })
    }
}
