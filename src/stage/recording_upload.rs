//! Films on the graphics card: once a film was recorded, its reels are sent there, in
//! single precision, and what they show is played without the processor.
//!
//! Guarantees: nothing waits for it, and the picture is the same before and after; a
//! film that the card has no room for is played as if there were no card. Does not
//! guarantee films on a card that is lost and found again: such a program puts its
//! transitions on the stage anew.

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

/// Storage buffers of Bevy's own that a vertex shader of ours may have beside the film.
const OTHERS: u32 = 3;

/// A graphics card whose vertex shaders read buffers; there is none where they do not.
#[derive(Resource, Clone)]
pub(super) struct CardRecording {
    device: RenderDevice,
    /// What a material has in the place of a film.
    nothing: Buffer,
    /// What a reel may take, in bytes.
    most_bytes: u64,
}

impl CardRecording {
    pub(super) fn nothing(&self) -> &Buffer {
        &self.nothing
    }
}

/// Looks whether there is such a card.
pub(super) fn find_card(
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
        && limits.max_storage_buffers_per_shader_stage > OTHERS
    {
        commands.insert_resource(CardRecording {
            nothing: buffer(&device, &[[0.0; 2]]),
            most_bytes: limits
                .max_storage_buffer_binding_size
                .min(limits.max_buffer_size),
            device: device.clone(),
        });
    }
}

fn buffer(device: &RenderDevice, numbers: &[[f32; 2]]) -> Buffer {
    device.create_buffer_with_data(&BufferInitDescriptor {
        label: Some("film"),
        contents: bytemuck::cast_slice(numbers),
        usage: BufferUsages::STORAGE,
    })
}

/// Sends films that have been recorded since.
pub(super) fn send_films(
    mut commands: Commands,
    card: Option<Res<CardRecording>>,
    morphs: Query<(Entity, &Morph, &Children), Without<UploadState>>,
    parts: Query<&StagePart>,
) {
    let Some(card) = card else {
        return;
    };
    for (entity, morph, children) in &morphs {
        let transition = morph.frame().transition();
        let mut parts = parts.iter_many(children);
        let played = parts.find(|part| matches!(part.paint, StagePaint::Played(_)));
        if let (Some(Ok(film)), Some(part)) = (transition.film(), played) {
            let (card, film, origin) = (card.clone(), film.clone(), part.origin);
            let vertices = morph.frame().placement().in_frame.len();
            let task = AsyncComputeTaskPool::get()
                .spawn(async move { card.send(film, vertices, origin).await });
            commands.entity(entity).try_insert(UploadState::Under(task));
        }
    }
}

/// Takes in those that have arrived.
pub(super) fn take_films(mut films: Query<&mut UploadState>) {
    for mut sent in &mut films {
        if let UploadState::Under(task) = sent.bypass_change_detection()
            && let Some(arrived) = check_ready(task)
        {
            *sent = arrived.map_or(UploadState::Refused, UploadState::There);
        }
    }
}

impl CardRecording {
    async fn send(
        self,
        film: Recording,
        vertices: usize,
        origin: DVec2,
    ) -> Option<UploadedIntervals> {
        let device = self.device.wgpu_device();
        // Unheard, it would end the program.
        let scope = device.push_error_scope(ErrorFilter::OutOfMemory);
        let reels = film.singles(vertices, origin);
        let reels: Option<Vec<UploadedInterval>> = reels.map(|single| self.reel(&single)).collect();
        let error = scope.pop().await;
        let reels = reels.filter(|reels| error.is_none() && !reels.is_empty())?;
        Some(UploadedIntervals { film, reels })
    }

    fn reel(&self, single: &SinglePrecisionInterval) -> Option<UploadedInterval> {
        let bytes = size_of_val(&single.numbers[..]) as u64;
        (bytes <= self.most_bytes).then(|| UploadedInterval {
            rows: buffer(&self.device, &single.numbers),
            vertices: single.vertices,
            coefficients: single.coefficients,
        })
    }
}
