//! Captures of the stage: pictures of any size on a coloured or transparent background, drawn off
//! screen by a separate camera.
//!
//! Guaranteed: each [`CaptureStage`] is answered by exactly one [`StageCaptured`], with the picture
//! or an error message for the user; colours are blended as in exported files; panels and other
//! windows are not captured. Not guaranteed: the exact frame of the request. The graphics card may
//! have to compile shaders first; the answer reports the t of the picture.

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

/// Requests a picture of the stage.
#[derive(Message, Clone, Debug)]
pub struct CaptureStage {
    /// Identifier that the answer repeats.
    pub id: u64,
    /// Width and height in pixels.
    pub size_px: UVec2,
    /// Background colour; `None` is transparent.
    pub ground: Option<Rgb>,
    /// Part of the plane to show. All of it is visible, centred in the picture.
    pub view: Bounds,
}

/// Answer to a [`CaptureStage`].
#[derive(Message, Clone, Debug)]
pub struct StageCaptured {
    /// Identifier of the request.
    pub id: u64,
    /// Blend parameter shown in the picture; `None` if the stage was empty.
    pub t: Option<f64>,
    /// Picture with straight (not premultiplied) alpha, top row first, or an error message for the
    /// user.
    pub result: Result<RgbaImage, String>,
}

/// Captures in progress.
#[derive(Resource, Default)]
pub(super) struct PendingCaptures(Vec<CaptureTarget>);

/// A capture in progress: the off-screen camera, its image, and the screenshot once it was
/// requested.
struct CaptureTarget {
    id: u64,
    camera: Entity,
    image: Handle<Image>,
    shot: Option<Entity>,
    t: Option<f64>,
    /// Number of frames waited so far.
    frames: u32,
}

/// Resources of the renderer that a capture needs; all missing without a renderer.
#[derive(SystemParam)]
pub(super) struct RenderAccess<'w> {
    /// Images, to which each capture adds its target.
    images: Option<ResMut<'w, Assets<Image>>>,
    /// The graphics card, which limits the size of images.
    device: Option<Res<'w, RenderDevice>>,
    /// Whether the shaders have been compiled.
    pipelines: Option<Res<'w, PipelinesReady>>,
}

/// Spawns a camera for each request.
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
        // The target has another format than the window, so it may need other pipelines.
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

/// Answer to a request that failed for the given reason.
fn failed_capture(id: u64, reason: &str) -> StageCaptured {
    StageCaptured {
        id,
        t: None,
        result: Err(format!("image capture failed: {reason}")),
    }
}

/// Off-screen camera that renders the requested part of the plane into `image`.
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

/// Takes each picture once the graphics card is ready; gives up after [`MAX_WAIT_FRAMES`] frames.
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
            // If there are several entities, t of the first one is reported.
            capture.t = blends.iter().next().map(|blend| blend.t);
            let shot = Screenshot::image(capture.image.clone());
            capture.shot = Some(commands.spawn(shot).observe(finish_capture).id());
        }
        if capture.frames <= MAX_WAIT_FRAMES {
            return true;
        }
        // Otherwise the camera would draw in every later frame.
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

/// Answers a request when its screenshot arrives.
fn finish_capture(
    shot: On<ScreenshotCaptured>,
    mut commands: Commands,
    mut answers: MessageWriter<StageCaptured>,
    mut captures: ResMut<PendingCaptures>,
) {
    let is_of_shot = |capture: &CaptureTarget| capture.shot == Some(shot.entity);
    // Otherwise the capture was given up and has been answered.
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
            // The camera blends in sRGB over a transparent background, which leaves sRGB colours
            // multiplied by alpha.
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
