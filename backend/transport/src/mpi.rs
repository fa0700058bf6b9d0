//! Bytes between the ranks of an MPI job.
//!
//! Point to point only. A collective waits for every rank and so hangs for good when one is lost; here nothing
//! blocks: a send is posted and completed later, a receive asks whether something has arrived. What is sent to
//! many ranks is encoded once, and its bytes are shared by all the sends.
//!
//! One message is one MPI message, whose length the receiver asks for before it takes it. The limit on a message is
//! far below the 2³¹ bytes that MPI can count, so neither a length in front nor pieces are needed.
//!
//! The calls are the C functions: the safe wrappers drop their return codes, and panic when a request is dropped
//! unfinished, which is just what a lost rank leaves behind.

use mpi::ffi;
use mpi::traits::{AsRaw, Communicator};
use protocol::wire::MESSAGE_LIMIT_BYTES;
use std::ffi::{c_char, c_int};
use std::mem::{ManuallyDrop, MaybeUninit};
use std::sync::Arc;

const _: () = assert!(MESSAGE_LIMIT_BYTES <= c_int::MAX as usize);

const TAG: c_int = 72;

/// A message on its way; MPI reads `_bytes` until the request is complete.
struct Sending {
    request: ffi::MPI_Request,
    _bytes: Arc<[u8]>,
}

/// A message that is coming in; MPI writes `bytes` until the request is complete.
struct Receiving {
    request: ffi::MPI_Request,
    bytes: Vec<u8>,
}

/// This rank's messages to and from the others. MPI is only called from the thread that made it.
pub struct Messenger {
    /// Finalised by [`Messenger::end`] alone: finalising waits for all ranks, so never on the way out of an error.
    universe: Option<ManuallyDrop<mpi::environment::Universe>>,
    rank: usize,
    comm: ffi::MPI_Comm,
    sending: Vec<Sending>,
    receiving: Vec<Option<Receiving>>,
}

impl Messenger {
    /// Initialises MPI. From now on errors are returned; by default MPI ends the process.
    pub fn start() -> Result<Self, String> {
        let (universe, _) = mpi::initialize_with_threading(mpi::Threading::Funneled)
            .ok_or("MPI was initialised twice in one process")?;
        let world = universe.world();
        let (rank, size) = (world.rank() as usize, world.size());
        let comm = world.as_raw();
        // SAFETY: MPI is initialised and `comm` is its world.
        check(unsafe { ffi::MPI_Comm_set_errhandler(comm, ffi::RSMPI_ERRORS_RETURN) })?;
        let receiving = (0..size).map(|_| None).collect();
        let universe = Some(ManuallyDrop::new(universe));
        Ok(Self { universe, rank, comm, sending: Vec::new(), receiving })
    }

    /// This process's rank.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// The number of ranks.
    pub fn size(&self) -> usize {
        self.receiving.len()
    }

    /// Posts `bytes` to rank `to`; [`Messenger::is_sending`] says when they are gone. It does not ask for progress itself: on a
    /// host with more ranks than cores MPI yields the core whenever it is asked, and a message to many asks once.
    pub fn post(&mut self, to: usize, bytes: Arc<[u8]>) -> Result<(), String> {
        let mut request = MaybeUninit::uninit();
        // SAFETY: the bytes live in `self.sending` until the request is complete, and beyond if it never is.
        let request = unsafe {
            check(ffi::MPI_Isend(
                bytes.as_ptr().cast(),
                count(bytes.len())?,
                ffi::RSMPI_UINT8_T,
                to as c_int,
                TAG,
                self.comm,
                request.as_mut_ptr(),
            ))?;
            request.assume_init()
        };
        self.sending.push(Sending { request, _bytes: bytes });
        Ok(())
    }

    /// Advances pending messages, and returns whether any are left.
    pub fn is_sending(&mut self) -> Result<bool, String> {
        let mut index = 0;
        while index < self.sending.len() {
            if is_complete(&mut self.sending[index].request)? {
                self.sending.remove(index);
            } else {
                index += 1;
            }
        }
        Ok(!self.sending.is_empty())
    }

    /// Whether a message is on its way in or out: then it pays to check again soon.
    pub fn is_moving(&self) -> bool {
        !self.sending.is_empty() || self.receiving.iter().any(Option::is_some)
    }

    /// The next message from rank `from`, if it has arrived.
    pub fn poll(&mut self, from: usize) -> Result<Option<Vec<u8>>, String> {
        if self.receiving[from].is_none() {
            self.receiving[from] = self.begin(from)?;
        }
        let Some(receiving) = &mut self.receiving[from] else { return Ok(None) };
        if !is_complete(&mut receiving.request)? {
            return Ok(None);
        }
        Ok(self.receiving[from].take().map(|complete| complete.bytes))
    }

    /// Starts receiving a message from rank `from`, if one is coming.
    fn begin(&self, from: usize) -> Result<Option<Receiving>, String> {
        let mut is_coming: c_int = 0;
        let mut status = MaybeUninit::uninit();
        let mut length: c_int = 0;
        // SAFETY: all pointers are to variables of this frame; the status is read only after MPI has filled it in.
        unsafe {
            check(ffi::MPI_Iprobe(from as c_int, TAG, self.comm, &mut is_coming, status.as_mut_ptr()))?;
            if is_coming == 0 {
                return Ok(None);
            }
            check(ffi::MPI_Get_count(status.as_ptr(), ffi::RSMPI_UINT8_T, &mut length))?;
        }
        let length = usize::try_from(length).ok().filter(|&length| length <= MESSAGE_LIMIT_BYTES);
        let length = length.ok_or("it sends a message over the limit")?;
        let mut bytes = vec![0; length];
        let mut request = MaybeUninit::uninit();
        // SAFETY: the vector is not touched again before the request is complete, and never freed if that never is.
        let request = unsafe {
            check(ffi::MPI_Irecv(
                bytes.as_mut_ptr().cast(),
                count(length)?,
                ffi::RSMPI_UINT8_T,
                from as c_int,
                TAG,
                self.comm,
                request.as_mut_ptr(),
            ))?;
            request.assume_init()
        };
        Ok(Some(Receiving { request, bytes }))
    }

    /// Finalises MPI, which waits for all ranks to do the same. Nothing may be called after it.
    pub fn end(&mut self) {
        let universe = self.universe.take().map(ManuallyDrop::into_inner);
        drop(universe);
    }
}

impl Drop for Messenger {
    /// MPI may still read or write the memory of unfinished requests, so that memory is leaked.
    fn drop(&mut self) {
        std::mem::forget(std::mem::take(&mut self.sending));
        std::mem::forget(std::mem::take(&mut self.receiving));
    }
}

/// Ends all ranks if MPI is running; call it from the thread that started MPI.
pub fn abort_if_running(exit_code: c_int) {
    let (mut is_up, mut is_down): (c_int, c_int) = (0, 0);
    // SAFETY: these three may be called at any time; abort only between initialising and finalising.
    unsafe {
        ffi::MPI_Initialized(&mut is_up);
        ffi::MPI_Finalized(&mut is_down);
        if is_up != 0 && is_down == 0 {
            ffi::MPI_Abort(ffi::RSMPI_COMM_WORLD, exit_code);
        }
    }
}

fn count(bytes: usize) -> Result<c_int, String> {
    c_int::try_from(bytes).map_err(|_| format!("a message of {bytes} bytes is more than MPI can count"))
}

fn is_complete(request: &mut ffi::MPI_Request) -> Result<bool, String> {
    let mut flag: c_int = 0;
    // SAFETY: the request is one of this messenger's; a complete one becomes the null request, which tests complete.
    check(unsafe { ffi::MPI_Test(request, &mut flag, ffi::RSMPI_STATUS_IGNORE) })?;
    Ok(flag != 0)
}

/// MPI's own words for a return code that is not success.
fn check(code: c_int) -> Result<(), String> {
    if code == ffi::MPI_SUCCESS as c_int {
        return Ok(());
    }
    let mut text = vec![0_u8; ffi::MPI_MAX_ERROR_STRING as usize + 1];
    let mut length: c_int = 0;
    // SAFETY: the buffer has the length MPI asks for.
    unsafe { ffi::MPI_Error_string(code, text.as_mut_ptr().cast::<c_char>(), &mut length) };
    text.truncate(usize::try_from(length).unwrap_or(0));
    Err(format!("MPI says: {}", String::from_utf8_lossy(&text)))
}
