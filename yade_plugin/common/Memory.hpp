// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <cstdlib> // says which C library this is
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace masonry {

// Gives memory that is free back to the system, after work that took much of it for a moment.
inline void giveMemoryBack() {
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
}

} // namespace masonry
