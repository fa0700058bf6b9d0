//! How messages travel: threads in one process, or MPI.
