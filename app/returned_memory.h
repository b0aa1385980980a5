#pragma once

namespace stiffscope::app {

/// Lets blocks of a megabyte and more (tables, a rendered picture) go back to the system as soon as they are free. glibc by
/// itself keeps such memory for blocks to come, from the first that is freed on; here what comes is smaller, or of another
/// library. To be called before the first such block; does nothing where the C library has no such setting.
void returnLargeBlocks();

/// Gives back what is free now, smaller blocks too, and pages of the libraries' code, of which compiling shaders reads fifty
/// megabytes once: after one kind of work, before another that needs its own.
void returnFreeMemory();

}  // namespace stiffscope::app
