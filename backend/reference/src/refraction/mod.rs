//! Light along a path that the refraction index bends.

mod bending;
mod bent_light;
mod follower;
mod interface;
#[cfg(test)]
mod laws;
mod runge_kutta;

pub use bent_light::BentLight;
