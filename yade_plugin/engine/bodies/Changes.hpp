// SPDX-License-Identifier: GPL-2.0-or-later
// Counts the changes of joints, deformable units and properties. When the number has changed, SceneStore reads its
// scene anew.
#pragma once
#include <atomic>

namespace masonry {

inline std::atomic<long> changes{0};

} // namespace masonry
