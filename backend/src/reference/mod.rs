//! The f64 truth: adaptive quadrature of the continuous optical model.
