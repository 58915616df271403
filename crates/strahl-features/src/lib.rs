//! Nothing but dependencies: the features that the workspace as a whole asks of its libraries.
//!
//! Cargo compiles a library anew for each set of its features. A program or module that is built by itself asks for fewer features than the tests of the
//! workspace do, so nearly everything that was compiled for the tests would be compiled again. What depends on this crate asks for the same.
