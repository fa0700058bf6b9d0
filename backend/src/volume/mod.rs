//! Volumes as users have them: file readers and procedural fields.
