// SPDX-License-Identifier: GPL-2.0-or-later
#include "Bo1_MasonryBlock_Aabb.hpp"
#include "MasonryBlock.hpp"

template class masonry::Adapter<masonry::Bo1_MasonryBlock_Aabb, yade::BoundFunctor>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::Bo1_MasonryBlock_Aabb)

namespace masonry {

void Bo1_MasonryBlock_Aabb::go(const shared_ptr<yade::Shape>& shape, shared_ptr<yade::Bound>& bound,
                               const yade::Se3& place, const yade::Body* body) {
    if (!bound)
        bound = boost::static_pointer_cast<yade::Bound>(Singleton<yade::ClassFactory>::instance().createShared("Aabb"));
    const auto& corners = static_cast<const MasonryBlock&>(*shape).v;
    if (anyTurn && (body->state->blockedDOFs >> 3) != 7) {
        double radius = 0;
        for (const auto& corner : corners)
            radius = std::max(radius, corner.norm());
        bound->min = place.position - Vector3r::Constant(radius);
        bound->max = place.position + Vector3r::Constant(radius);
        return;
    }
    const yade::Matrix3r turn = place.orientation.toRotationMatrix();
    bound->min.setConstant(HUGE_VAL);
    bound->max.setConstant(-HUGE_VAL);
    for (const auto& corner : corners) {
        const Vector3r at = place.position + turn * corner;
        bound->min = bound->min.cwiseMin(at);
        bound->max = bound->max.cwiseMax(at);
    }
}

} // namespace masonry
