//! Tools, lines and labels, drawn over the picture of each projector where the rays of its pixels meet them.
