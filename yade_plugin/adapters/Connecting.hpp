// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom.hpp"
#include "Ip2_MasonryMat_MasonryMat_MasonryJointPhys.hpp"

namespace masonry {

// Makes the joints of pairs of bodies. `rule` is a function (body1, body2, geom) that gives a MasonryJoint or None;
// without it, or for None, the first that fits of physics.joints is taken. Returns the interactions, their MasonryJoint
// objects, and sentences about what is wrong. If anything is, no joint is left.
py::tuple connect(const py::list& pairs, const shared_ptr<Ig2_MasonryBlock_MasonryBlock_MasonryJointGeom>& geometry,
                  const shared_ptr<Ip2_MasonryMat_MasonryMat_MasonryJointPhys>& physics, const py::object& rule);

} // namespace masonry
