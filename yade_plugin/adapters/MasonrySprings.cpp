// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonrySprings.hpp"

MASONRY_DEFINE(MasonrySprings)

namespace masonry {

void MasonrySprings::step(SceneStore& store) { act(store); }

} // namespace masonry
