// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryJointGeom.hpp"

MASONRY_DEFINE(MasonryJointGeom)

namespace masonry {

const JointShapes& MasonryJointGeom::shapes() const {
    if (!group) throw std::runtime_error("this MasonryJointGeom is of no joint: connect() makes joints");
    group->check();
    return *group;
}

Vector3r MasonryJointGeom::normal() { return group ? shapes().joints[index].normal : Vector3r::Zero(); }
Vector3r MasonryJointGeom::tangent() { return group ? shapes().joints[index].tangent : Vector3r::Zero(); }
std::vector<Vector3r> MasonryJointGeom::polygon() {
    return group ? shapes().joints[index].polygon() : std::vector<Vector3r>();
}
double MasonryJointGeom::distance1() { return group ? shapes().joints[index].distance(0) : 0; }
double MasonryJointGeom::distance2() { return group ? shapes().joints[index].distance(1) : 0; }

shared_ptr<MasonryZones> MasonryJointGeom::zones() {
    return group && reference().attached ? boost::static_pointer_cast<MasonryZones>(reference().attached->zones)
                                         : shared_ptr<MasonryZones>();
}

// A file holds the zones before the record. They are kept in a group without subcontacts, which visitRecord() replaces.
void MasonryJointGeom::setZones(const shared_ptr<MasonryZones>& all) {
    group.reset();
    index = 0;
    if (!all) return;
    group.reset(new JointShapes(1, 0));
    group->joints[0].attached = std::make_shared<JointReference::Attached>();
    group->joints[0].attached->zones = all;
}

void MasonryJointGeom::visitRecord(StateNumbers& n) {
    if (group) shapes();
    std::size_t count = points();
    n.visitCount(count);
    if (count == 0) return;
    if (n.back) {
        const shared_ptr<JointShapes> made(new JointShapes(1, int(count)));
        if (group) made->joints[0].attached = reference().attached;
        group = made;
    }
    group->visitShape(index, n);
    group->visitState(index, n);
}

py::list MasonryJointGeom::centres() {
    const BetweenSteps still;
    py::list all;
    for (int p = 0; group && p < shapes().points; ++p)
        all.append(centre(p));
    return all;
}

py::list MasonryJointGeom::areas() {
    const BetweenSteps still;
    py::list all;
    for (int p = 0; group && p < shapes().points; ++p)
        all.append(area(p));
    return all;
}

py::list MasonryJointGeom::jumps() {
    const BetweenSteps still;
    py::list all;
    for (int p = 0; group && p < shapes().points; ++p)
        all.append(jump(p));
    return all;
}

} // namespace masonry
