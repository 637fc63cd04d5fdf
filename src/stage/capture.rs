//! Captures pictures of the stage, of any size and on a coloured or transparent background. A
//! separate camera draws each picture off screen.
//!
//! Guaranteed: each [`CaptureStage`] is answered by exactly one [`StageCaptured`], with the picture
//! or an error message for the user; colours are blended as in exported files; panels and other
//! windows are not captured. The picture may show another t than the stage did at the request,
//! because the graphics card may have to compile shaders first. The answer contains this t.

use bevy::camera::{CompositingSpace, RenderTarget};
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use bevy::render::renderer::RenderDevice;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use image::RgbaImage;

use crate::colour::Rgb;
use crate::export::make_straight;
use crate::geometry::Bounds;

use super::components::Blend;
use super::pipelines::PipelinesReady;
use super::stage_view::{StageView, units_per_px};

/// Maximum number of frames to wait for the graphics card, 20 s at 60 frames per second
/// (heuristic).
const MAX_WAIT_FRAMES: u32 = 1200;

/// Message that requests a picture of the stage.
#[derive(Message, Clone, Debug)]
pub struct CaptureStage {
    /// Identifier that the answer repeats.
    pub id: u64,
    /// Width and height of the picture, in pixels.
    pub size_px: UVec2,
    /// Background colour of the picture; `None` for a transparent background.
    pub ground: Option<Rgb>,
    /// Region of the plane to show: all of it is visible, centred in the picture.
    pub view: Bounds,
}

/// Message that answers a [`CaptureStage`].
#[derive(Message, Clone, Debug)]
pub struct StageCaptured {
    /// Identifier of the answered request.
    pub id: u64,
    /// Blend parameter shown in the picture; `None` if the stage was empty.
    pub t: Option<f64>,
    /// Picture with straight (not premultiplied) alpha, top row first, or an error message for the
    /// user.
    pub result: Result<RgbaImage, String>,
}

/// Captures that have been requested and not yet answered.
#[derive(Resource, Default)]
pub(super) struct PendingCaptures(Vec<CaptureTarget>);

/// A capture in progress: the off-screen camera and the image into which the camera renders. Once
/// the shaders are ready, also the screenshot of the image and the t that the screenshot shows.
struct CaptureTarget {
    id: u64,
    camera: Entity,
    image: Handle<Image>,
    shot: Option<Entity>,
    t: Option<f64>,
    /// Number of frames since the request.
    frames: u32,
}

/// Resources of the renderer that a capture needs. A program without a renderer has none of them.
#[derive(SystemParam)]
pub(super) struct RenderAccess<'w> {
    /// Image assets, to which each capture adds the image that it renders into.
    images: Option<ResMut<'w, Assets<Image>>>,
    /// The graphics card, which limits the size of images.
    device: Option<Res<'w, RenderDevice>>,
    /// Tracker of whether the graphics card has compiled all shaders.
    pipelines: Option<Res<'w, PipelinesReady>>,
}

/// Spawns an off-screen camera for each request, or answers the request with an error.
pub(super) fn begin_captures(
    mut commands: Commands,
    mut requests: MessageReader<CaptureStage>,
    mut answers: MessageWriter<StageCaptured>,
    mut captures: ResMut<PendingCaptures>,
    graphics: RenderAccess,
    view: Res<StageView>,
) {
    let RenderAccess {
        images: Some(mut images),
        device: Some(device),
        pipelines: Some(ready),
    } = graphics
    else {
        for request in requests.read() {
            answers.write(failed_capture(
                request.id,
                "this program runs without a graphics card",
            ));
        }
        return;
    };
    let largest = device.limits().max_texture_dimension_2d;
    for request in requests.read() {
        let size = request.size_px;
        if size.min_element() == 0 || size.max_element() > largest {
            let reason = format!(
                "the graphics card supports 1 to {largest} pixels per side, \
                 not {} × {}; choose another size",
                size.x, size.y
            );
            answers.write(failed_capture(request.id, &reason));
            continue;
        }
        let format = TextureFormat::Rgba8UnormSrgb;
        let image = images.add(Image::new_target_texture(size.x, size.y, format, None));
        let camera = commands.spawn(camera(request, &image, view.anchor())).id();
        // The image has another format than the window, so other pipelines may have to be compiled.
        ready.reset();
        captures.0.push(CaptureTarget {
            id: request.id,
            camera,
            image,
            shot: None,
            t: None,
            frames: 0,
        });
    }
}

/// Returns the answer to the request `id` with the reason why the capture failed.
fn failed_capture(id: u64, reason: &str) -> StageCaptured {
    StageCaptured {
        id,
        t: None,
        result: Err(format!("image capture failed: {reason}")),
    }
}

/// Returns an off-screen camera that renders the requested part of the plane into `image`.
fn camera(request: &CaptureStage, image: &Handle<Image>, anchor: glam::DVec2) -> impl Bundle {
    let at = (request.view.centre() - anchor).as_vec2();
    let ground = request
        .ground
        .map_or(Color::NONE, |Rgb([r, g, b])| Color::srgb_u8(r, g, b));
    let scale = units_per_px(request.view, request.size_px.as_vec2()) as f32;
    (
        Camera2d,
        Camera {
            order: -1,
            clear_color: ClearColorConfig::Custom(ground),
            ..default()
        },
        Projection::Orthographic(OrthographicProjection {
            scale,
            ..OrthographicProjection::default_2d()
        }),
        Transform::from_translation(at.extend(0.0)),
        RenderTarget::Image(image.clone().into()),
        Msaa::Sample4,
        CompositingSpace::Srgb,
    )
}

/// Requests the screenshot of each capture once the graphics card has compiled all shaders. A
/// capture whose picture has not arrived [`MAX_WAIT_FRAMES`] frames after the request is given up
/// and answered with an error.
pub(super) fn advance_captures(
    mut commands: Commands,
    mut answers: MessageWriter<StageCaptured>,
    mut captures: ResMut<PendingCaptures>,
    ready: Option<Res<PipelinesReady>>,
    blends: Query<&Blend>,
) {
    let is_ready = ready.is_some_and(|ready| ready.is_ready());
    captures.0.retain_mut(|capture| {
        capture.frames += 1;
        if is_ready && capture.shot.is_none() {
            // If several transitions are on the stage, the answer contains the t of the first.
            capture.t = blends.iter().next().map(|blend| blend.t);
            let shot = Screenshot::image(capture.image.clone());
            capture.shot = Some(commands.spawn(shot).observe(finish_capture).id());
        }
        if capture.frames <= MAX_WAIT_FRAMES {
            return true;
        }
        // The camera is despawned, because it would otherwise draw in every later frame.
        commands.entity(capture.camera).try_despawn();
        if let Some(shot) = capture.shot {
            commands.entity(shot).try_despawn();
        }
        answers.write(failed_capture(
            capture.id,
            "the graphics card did not respond in time; try again",
        ));
        false
    });
}

/// Observer that answers a request when its screenshot arrives.
fn finish_capture(
    shot: On<ScreenshotCaptured>,
    mut commands: Commands,
    mut answers: MessageWriter<StageCaptured>,
    mut captures: ResMut<PendingCaptures>,
) {
    let is_of_shot = |capture: &CaptureTarget| capture.shot == Some(shot.entity);
    // A capture that is no longer listed has already been answered with an error.
    let Some(index) = captures.0.iter().position(is_of_shot) else {
        return;
    };
    let capture = captures.0.swap_remove(index);
    commands.entity(capture.camera).try_despawn();
    let UVec2 { x, y } = shot.image.size();
    let data = shot.image.data.clone().unwrap_or_default();
    let picture = RgbaImage::from_raw(x, y, data);
    answers.write(match picture {
        Some(mut picture) => {
            // Blending in sRGB over a transparent background leaves sRGB colours multiplied by
            // alpha; the answer needs straight alpha.
            picture.pixels_mut().for_each(make_straight);
            StageCaptured {
                id: capture.id,
                t: capture.t,
                result: Ok(picture),
            }
        }
        None => failed_capture(
            capture.id,
            "the graphics card returned an incomplete picture; try again",
        ),
    });
}
