//! What a twin looks for, its slots apart.

/// What a twin looks for, decided when it is compiled.
pub trait Features {
    /// Whether it looks for levels, materials, detail, debug views and refraction.
    const IS_FULL: bool;
    /// Whether it looks for enhancers.
    const ENHANCES: bool;
    /// Whether it looks for nodes that blend into their parents.
    const BLENDS: bool;
    /// Whether its compositing slot reads importance.
    const READS_IMPORTANCE: bool;
}
