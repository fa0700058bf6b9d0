//! What kernels that cast are given.

use super::arena::Arena;
use super::device::GpuDevice;
use super::storage::{Storage, entries_of};
use layout::binding;
use needs::{Needs, Way};
use shaders::compose::{Filter, KernelKey, KernelRays};
use twin::SceneNumbers;

impl GpuDevice {
    /// The kernel for what a scene needs.
    pub(super) fn key(&self, rays: KernelRays, needs: Needs) -> KernelKey {
        KernelKey { rays, filter: self.filter, lookup: self.lookup, needs }
    }

    /// Uploads what all views of a scene share.
    pub(super) fn upload_scene(&self, scene: &SceneNumbers<f32>, needs: &Needs) {
        let queue = &self.context.queue;
        queue.write_buffer(&self.scene, 0, bytemuck::bytes_of(&scene.block(self.atlas.slots)));
        if !needs.chain.is_empty() {
            queue.write_buffer(&self.links, 0, bytemuck::cast_slice(&scene.links()));
        }
    }

    /// What kernels that cast rays read and write: of an arena, what is listed there.
    pub(super) fn entries<'a>(
        &'a self,
        key: KernelKey,
        arena: &'a Arena,
        feedback: &'a Storage,
    ) -> Vec<wgpu::BindGroupEntry<'a>> {
        let mut entries = self.entries_of_volume(key, feedback);
        entries.extend(entries_of([
            (binding::OPTICS, &self.optics),
            (binding::TABLE_CELLS, &self.table_cells),
            (binding::VIEWS, &arena.views),
            (binding::LISTED, &arena.listed),
            (binding::PIXELS, &arena.pixels),
            (binding::COUNTS, &arena.counts),
        ]));
        if !key.needs.chain.is_empty() {
            let resource = self.links.as_entire_binding();
            entries.push(wgpu::BindGroupEntry { binding: binding::LINKS, resource });
        }
        let tables = [
            (binding::IMPORTANCE, &self.importance, key.needs.reads_importance()),
            (binding::IMPORTANCE_MOST, &self.importance_most, key.needs.reads_importance()),
            (binding::INDEX, &self.index, key.needs.way == Way::Refracted),
            (binding::MATERIALS, &self.materials, key.needs.has_materials),
        ];
        for (binding, storage, _) in tables.into_iter().filter(|&(.., is_read)| is_read) {
            entries.push(wgpu::BindGroupEntry { binding, resource: storage.binding() });
        }
        entries
    }

    /// What kernels read that look up the transfer functions alone.
    pub(super) fn entries_of_tables(&self) -> Vec<wgpu::BindGroupEntry<'_>> {
        let tables = [(binding::OPTICS, &self.optics), (binding::TABLE_CELLS, &self.table_cells)];
        self.with_scene(tables)
    }

    /// What kernels read that look up there whether anything shows.
    pub(super) fn entries_of_cells(&self) -> Vec<wgpu::BindGroupEntry<'_>> {
        self.with_scene([(binding::TABLE_CELLS, &self.table_cells)])
    }

    /// What kernels read and write that sample the volume.
    pub(super) fn entries_of_volume<'a>(
        &'a self,
        key: KernelKey,
        feedback: &'a Storage,
    ) -> Vec<wgpu::BindGroupEntry<'a>> {
        let volume =
            [(binding::NODES, &self.nodes), (binding::CELLS, &self.cells), (binding::FEEDBACK, feedback)];
        let mut entries = self.with_scene(volume);
        let atlas = wgpu::BindingResource::TextureView(&self.atlas.view);
        entries.push(wgpu::BindGroupEntry { binding: binding::ATLAS, resource: atlas });
        if let Some(deviations) = self.deviations.as_ref().filter(|_| key.needs.spreads) {
            let resource = wgpu::BindingResource::TextureView(&deviations.view);
            entries.push(wgpu::BindGroupEntry { binding: binding::DEVIATIONS, resource });
        }
        if key.filter != Filter::Exact {
            let sampler = wgpu::BindingResource::Sampler(&self.sampler);
            entries.push(wgpu::BindGroupEntry { binding: binding::SAMPLER, resource: sampler });
        }
        entries
    }

    /// Some buffers, and the numbers of the scene.
    fn with_scene<'a, const N: usize>(
        &'a self,
        buffers: [(u32, &'a Storage); N],
    ) -> Vec<wgpu::BindGroupEntry<'a>> {
        let resource = self.scene.as_entire_binding();
        let scene = wgpu::BindGroupEntry { binding: binding::SCENE, resource };
        std::iter::once(scene).chain(entries_of(buffers)).collect()
    }
}
