// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ig2_MasonryBlock_Polyhedra_MasonryJointGeom.hpp"

MASONRY_DEFINE(Ig2_MasonryBlock_Polyhedra_MasonryJointGeom)
