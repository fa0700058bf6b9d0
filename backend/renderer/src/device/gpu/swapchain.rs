//! Windows that are painted with codes which stay on the device.

use super::adapters;
use super::context::Context;
use super::kept::{KeptCodes, row_bytes};
use super::pipeline_cache::PipelineCache;
use super::storage::uniform;
use crate::device::DeviceError;
use glam::{IVec2, UVec2};
use layout::{PaintBlock, binding};
use protocol::{Canvas, PaintedPart, WallError};
use shaders::compose::{PAINT_CORNER, PAINT_PIXEL, paint_wgsl};
use std::sync::{Arc, MutexGuard};
use wgpu::CurrentSurfaceTexture as Current;
use wgpu::rwh::{HasDisplayHandle, HasWindowHandle};

/// Formats whose numbers are codes as they stand.
const FORMATS: [wgpu::TextureFormat; 2] = [wgpu::TextureFormat::Bgra8Unorm, wgpu::TextureFormat::Rgba8Unorm];

/// How often it is tried to configure one.
const CONFIGURE_ATTEMPTS: usize = 4;

/// What makes swapchains for windows.
#[derive(Clone, Debug)]
pub struct Swapchains(Arc<Context>);

impl Swapchains {
    pub(super) fn new(context: Arc<Context>) -> Self {
        Self(context)
    }

    /// Whether the processor paints.
    pub fn is_software(&self) -> bool {
        self.0.is_software
    }

    /// The longest edge of a window that can be painted, pixels.
    pub fn longest_edge(&self) -> u32 {
        self.0.device.limits().max_texture_dimension_2d
    }

    /// One for all of a window, which has this size as long as the swapchain lives.
    ///
    /// # Errors
    /// The device cannot show anything in such a window.
    pub fn open(
        &self,
        window: impl HasWindowHandle + HasDisplayHandle + Send + Sync + 'static,
        size: UVec2,
    ) -> Result<Swapchain, DeviceError> {
        let Self(context) = self;
        let refused = |why: String| DeviceError(format!("{} does not paint windows: {why}", context.name));
        let target = wgpu::SurfaceTarget::DisplayAndWindow(Box::new(window));
        let surface = adapters::instance().create_surface(target).map_err(|e| refused(e.to_string()))?;
        if !context.adapter.is_surface_supported(&surface) {
            return Err(refused("it is not the one that this window's server shows with".to_owned()));
        }
        let offered = surface.get_capabilities(context.adapter).formats;
        let format = FORMATS.into_iter().find(|format| offered.contains(format));
        let format =
            format.ok_or_else(|| refused("none of its formats has 8 bits for each colour".to_owned()))?;
        let config = wgpu::SurfaceConfiguration {
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            format,
            color_space: wgpu::SurfaceColorSpace::Auto,
            width: size.x,
            height: size.y,
            // In step with the refreshes of the output, as early as can be.
            present_mode: wgpu::PresentMode::Fifo,
            desired_maximum_frame_latency: 1,
            alpha_mode: wgpu::CompositeAlphaMode::Auto,
            view_formats: Vec::new(),
        };
        let pipeline = pipeline(context, format);
        let swapchain = Swapchain {
            context: Arc::clone(context),
            surface,
            config,
            pipeline,
            blocks: Vec::new(),
            painted: None,
        };
        swapchain.configure().map_err(refused)?;
        Ok(swapchain)
    }
}

/// The pictures that a window shows one after the other.
#[derive(Debug)]
pub struct Swapchain {
    /// What is painted and not shown. It is dropped before what it belongs to.
    painted: Option<wgpu::SurfaceTexture>,
    context: Arc<Context>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    pipeline: wgpu::RenderPipeline,
    /// A uniform block for each part.
    blocks: Vec<wgpu::Buffer>,
}

impl Canvas for Swapchain {
    fn ready(&mut self, parts: &[PaintedPart]) -> Result<(), WallError> {
        self.ready_or_fail(parts).map_err(|DeviceError(why)| WallError(why))
    }

    fn show(&mut self) -> bool {
        let _turn = turn(&self.context);
        let painted = self.painted.take();
        let is_there = painted.is_some();
        painted.into_iter().for_each(|texture| self.context.queue.present(texture));
        is_there
    }
}

impl Swapchain {
    fn ready_or_fail(&mut self, parts: &[PaintedPart]) -> Result<(), DeviceError> {
        if self.painted.is_none() {
            self.painted = self.next()?;
        }
        let Some(texture) = &self.painted else { return Ok(()) };
        let context = Arc::clone(&self.context);
        let _turn = turn(&context);
        let view = texture.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let blocks = self.blocks.len().max(parts.len());
        self.blocks.resize_with(blocks, || uniform::<PaintBlock>(&context, "paint"));
        let mut encoder = context.new_encoder();
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("paint"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        for (part, block) in parts.iter().zip(&self.blocks) {
            self.paint(&mut pass, part, block)?;
        }
        drop(pass);
        context.submit(encoder);
        Ok(())
    }

    /// Notes that a part is painted, as far as it lies in the window.
    fn paint(
        &self,
        pass: &mut wgpu::RenderPass,
        part: &PaintedPart,
        uniform: &wgpu::Buffer,
    ) -> Result<(), DeviceError> {
        let context = &self.context;
        let codes = part.codes.codes.downcast_ref::<KeptCodes>();
        let codes = codes.ok_or_else(|| {
            DeviceError(format!("{} is to paint what is not on it; please report this line", context.name))
        })?;
        let picture = UVec2::new(codes.raster.width as u32, codes.raster.height as u32);
        let size = part.turn.size(picture).min(part.room);
        if size.min_element() == 0 {
            return Ok(());
        }
        let block = paint_block(part, picture, row_bytes(codes.raster) as i32);
        context.queue.write_buffer(uniform, 0, bytemuck::bytes_of(&block));
        let bind_group = context.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: binding::PAINT, resource: uniform.as_entire_binding() },
                wgpu::BindGroupEntry { binding: binding::CODES, resource: codes.stretch().binding() },
            ],
        });
        pass.set_scissor_rect(part.first_px.x, part.first_px.y, size.x, size.y);
        pass.set_bind_group(0, &bind_group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }

    /// What to paint into; None where nobody would see it.
    fn next(&self) -> Result<Option<wgpu::SurfaceTexture>, DeviceError> {
        match self.current() {
            Current::Success(texture) | Current::Suboptimal(texture) => Ok(Some(texture)),
            Current::Timeout | Current::Occluded => Ok(None),
            // Once: after that somebody else changes the window all the time, and the next frame comes soon.
            Current::Outdated | Current::Validation => {
                self.configure().map_err(|why| self.gone(&why))?;
                match self.current() {
                    Current::Success(texture) | Current::Suboptimal(texture) => Ok(Some(texture)),
                    Current::Lost => Err(self.gone("it is lost")),
                    _ => Ok(None),
                }
            }
            Current::Lost => Err(self.gone("it is lost")),
        }
    }

    /// The same as the driver says it, without the library's panic.
    fn current(&self) -> Current {
        let _turn = turn(&self.context);
        let scope = self.context.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let current = self.surface.get_current_texture();
        let error = pollster::block_on(scope.pop());
        if error.is_some() { Current::Validation } else { current }
    }

    fn gone(&self, why: &str) -> DeviceError {
        DeviceError(format!("{} cannot paint its window any more: {why}", self.context.name))
    }

    /// Gives it its size and format. The library does so only while nobody else hands the device work, so that it takes a turn,
    /// and tries again where another window was painted meanwhile.
    fn configure(&self) -> Result<(), String> {
        let Context { device, .. } = &*self.context;
        let _turn = self.context.turn();
        let attempt = || {
            let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
            self.surface.configure(device, &self.config);
            let failed = pollster::block_on(scope.pop())?;
            // The last line is the cause.
            Some(failed.to_string().lines().next_back().unwrap_or_default().trim().to_owned())
        };
        let mut failed = attempt();
        for _ in 1..CONFIGURE_ATTEMPTS {
            failed = failed.and_then(|_| attempt());
        }
        failed.map_or(Ok(()), Err)
    }
}

/// Drivers in software are used by one thread at a time. With others the next picture of a window may be long in coming, and
/// nobody else is to wait for that.
fn turn(context: &Context) -> Option<MutexGuard<'_, ()>> {
    context.is_software.then(|| context.turn())
}

fn paint_block(part: &PaintedPart, picture: UVec2, row_bytes: i32) -> PaintBlock {
    let [right, down] = part.turn.steps();
    let wide = |a: IVec2, b: IVec2| [a.x, a.y, b.x, b.y];
    PaintBlock {
        place: wide(part.first_px.as_ivec2(), IVec2::ZERO),
        source: wide(part.turn.corner(picture).as_ivec2(), IVec2::new(row_bytes, 0)),
        steps: wide(right, down),
    }
}

fn pipeline(context: &Context, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
    let module = context.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("paint"),
        source: wgpu::ShaderSource::Wgsl(paint_wgsl().into()),
    });
    context.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("paint"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(PAINT_CORNER),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(PAINT_PIXEL),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: context.pipelines.as_ref().map(PipelineCache::cache),
    })
}
