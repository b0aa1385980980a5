#pragma once

namespace stiffscope::app {

/// Asks for large pages for the heap, and for memory that was freed to be kept for what comes next, where the C library
/// and the system can. Campaigns of ten thousand postures fill a hundred megabytes: each page of four kilobytes that is
/// touched for the first time costs the system's attention, and large blocks would be given back and fetched anew all
/// the time.
void useLargeHeapPages();

}  // namespace stiffscope::app
