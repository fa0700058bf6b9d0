//! A device of either kind, with its brick cache.

use super::{
    CastJob, CastOutcome, Codes, CpuDevice, DeviceError, DevicePicture, FeedbackTag, FinishJob, ShortJob,
    ShowJob, TaggedFeedback,
};
use crate::present::Raster;
use layout::NodeRecord;
use needs::Needs;
use needs::tables::Tables;
use protocol::CodesAt;
use std::borrow::Cow;
use twin::ProjectorRays;

/// A device with its brick cache.
#[derive(Debug)]
pub enum Device {
    /// The twin, on all cores.
    Cpu(Box<CpuDevice>),
    /// A wgpu device.
    #[cfg(feature = "gpu")]
    Gpu(Box<super::gpu::GpuDevice>),
}

/// The same call on whichever device there is.
macro_rules! on_device {
    ($device:expr, $found:ident => $call:expr) => {
        match $device {
            Device::Cpu($found) => $call,
            #[cfg(feature = "gpu")]
            Device::Gpu($found) => $call,
        }
    };
}

impl Device {
    /// Slots of the brick cache.
    pub fn slots(&self) -> u32 {
        on_device!(self, device => device.slots())
    }

    /// Why it cannot cast row planes for a scene with these needs.
    pub fn refuses_planes(&self, needs: &Needs) -> Option<&'static str> {
        on_device!(self, device => device.refuses_planes(needs))
    }

    /// Whether it is the CPU.
    pub fn is_cpu(&self) -> bool {
        matches!(self, Self::Cpu(_))
    }

    /// Puts a brick's 32³ samples into a slot.
    pub fn write_brick(&mut self, slot: u32, samples: &[u16]) {
        on_device!(self, device => device.write_brick(slot, samples));
    }

    /// Puts the 32³ standard deviations of a brick's samples into its slot; the cache was made with room for them.
    pub fn write_deviations(&mut self, slot: u32, codes: &[u8]) {
        on_device!(self, device => device.write_deviations(slot, codes));
    }

    /// Replaces the spatial index, and which cells of each slot show anything.
    pub fn write_index(&mut self, nodes: &[NodeRecord], cells: &[u32]) {
        on_device!(self, device => device.write_index(nodes, cells));
    }

    /// Replaces the transfer functions' tables.
    pub fn write_tables(&mut self, tables: Tables) {
        on_device!(self, device => device.write_tables(tables));
    }

    /// From now on the casts that gather for the frame ([`super::Gather::Frame`]) add to an empty table. An index that is
    /// written meanwhile empties it again: places mean other nodes then.
    pub fn clear_feedback(&mut self) {
        on_device!(self, device => device.clear_feedback());
    }

    /// The frame's table is complete: starts it on its way to the host, with the tag, and waits for nothing. Of the tables
    /// that nobody takes only the latest few are kept.
    pub fn end_feedback(&mut self, tag: FeedbackTag) {
        on_device!(self, device => device.end_feedback(tag));
    }

    /// Whether any table is under way.
    pub fn has_feedback_under_way(&self) -> bool {
        on_device!(self, device => device.has_feedback_under_way())
    }

    /// The oldest table that is under way; None where there is none, or it has not arrived. It never waits.
    ///
    /// # Errors
    /// The device stopped answering.
    pub fn take_feedback(&mut self) -> Result<Option<TaggedFeedback>, DeviceError> {
        on_device!(self, device => device.take_feedback())
    }

    /// The same, but waits for it; None where none is under way.
    ///
    /// # Errors
    /// The device stopped answering.
    pub fn wait_feedback(&mut self) -> Result<Option<TaggedFeedback>, DeviceError> {
        on_device!(self, device => device.wait_feedback())
    }

    /// Casts the rays of some views; their colours stay on the device, a picture per view. It returns when they
    /// are, or when it has been asked to leave off.
    ///
    /// # Errors
    /// The device stopped answering.
    pub fn cast(&mut self, job: &CastJob) -> Result<CastOutcome, DeviceError> {
        on_device!(self, device => device.cast(job))
    }

    /// Casts short rays: the colour of each, premultiplied by its opacity, view by view in their order. They tell nothing of what
    /// they need.
    ///
    /// # Errors
    /// The device stopped answering.
    pub fn cast_short(&mut self, job: &ShortJob) -> Result<Vec<Vec<[f32; 4]>>, DeviceError> {
        on_device!(self, device => device.cast_short(job))
    }

    /// Makes what is shown of what was cast last into some pictures (see [`CastJob::first_picture`]), and of what was shown of
    /// them before. Whether any pixel of each is not yet as it was cast, because it may not change by so much.
    ///
    /// # Errors
    /// The device stopped answering.
    ///
    /// # Panics
    /// Where nothing was cast into one yet.
    pub fn show(&mut self, jobs: &[ShowJob]) -> Result<Vec<bool>, DeviceError> {
        on_device!(self, device => device.show(jobs))
    }

    /// How many of some views a complete frame casts together, one at least.
    pub fn views_at_once(&self, views: &[ProjectorRays<f32>]) -> usize {
        on_device!(self, device => device.views_at_once(views))
    }

    /// How many pictures are best shown and handed over together: on the CPU one after the other, which is in its cache then.
    pub fn pictures_at_once(&self) -> usize {
        match self {
            Self::Cpu(_) => 1,
            #[cfg(feature = "gpu")]
            Self::Gpu(_) => usize::MAX,
        }
    }

    /// The colours of some pictures: 4 numbers per pixel, rows from the top. A GPU hands them over together.
    ///
    /// # Errors
    /// The device stopped answering.
    ///
    /// # Panics
    /// Where one is not there yet.
    pub fn pictures(&mut self, pictures: &[DevicePicture]) -> Result<Vec<Cow<'_, [f32]>>, DeviceError> {
        on_device!(self, device => device.pictures(pictures))
    }

    /// Those of one.
    ///
    /// # Errors
    /// The device stopped answering.
    ///
    /// # Panics
    /// Where it is not there yet.
    pub fn picture(&mut self, picture: DevicePicture) -> Result<Cow<'_, [f32]>, DeviceError> {
        Ok(self.pictures(&[picture])?.remove(0))
    }

    /// The codes of some pictures, where they are wanted. The CPU has them in main memory, wherever they are wanted.
    ///
    /// # Errors
    /// The device stopped answering.
    ///
    /// # Panics
    /// Where a picture is not there yet.
    pub fn codes(&mut self, jobs: &[FinishJob], at: CodesAt) -> Result<Vec<Codes>, DeviceError> {
        on_device!(self, device => device.codes(jobs, at))
    }

    /// The same of a picture whose codes were made on the host.
    pub fn codes_of_host(&mut self, codes: Vec<u8>, raster: Raster, at: CodesAt) -> Codes {
        on_device!(self, device => device.codes_of_host(codes, raster, at))
    }

    /// What makes swapchains that show codes which it has; None where it can make none.
    #[cfg(feature = "gpu")]
    pub fn swapchains(&self) -> Option<super::gpu::Swapchains> {
        match self {
            Self::Cpu(_) => None,
            Self::Gpu(device) => Some(device.swapchains()),
        }
    }
}
