//! What an exhibit is: its file, the log of its day, and the state that a supervisor reads.
