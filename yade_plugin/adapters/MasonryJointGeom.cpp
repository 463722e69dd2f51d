// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryJointGeom.hpp"

template class masonry::Adapter<masonry::MasonryJointGeom, yade::IGeom>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryJointGeom)

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

// A file holds the zones before the record. They are kept in a group without subcontacts, which setRecord() replaces.
void MasonryJointGeom::setZones(const shared_ptr<MasonryZones>& all) {
    group.reset();
    index = 0;
    if (!all) return;
    group.reset(new JointShapes(1, 0));
    group->joints[0].attached = std::make_shared<JointReference::Attached>();
    group->joints[0].attached->zones = all;
}

namespace {

// Writes the numbers of a joint one after another, or reads them in the same order.
class Numbers {
public:
    explicit Numbers(bool back) : back_(back) {}
    Numbers(bool back, const std::vector<double>& flat) : flat(flat), back_(back) {}

    template <class T> void operator()(T& value) {
        if constexpr (std::is_integral<T>::value) {
            double number = double(value);
            one(number);
            if (!(std::abs(number) < 1e9)) damaged();
            value = T(number);
        } else
            numbers(value, [this](double& number) { one(number); });
    }
    template <class T> void list(std::vector<T>& values) {
        std::size_t count = values.size();
        (*this)(count);
        if (back_) {
            if (count > flat.size()) damaged();
            values.resize(count);
        }
        for (auto& value : values)
            (*this)(value);
    }
    [[noreturn]] static void damaged() { throw std::runtime_error("saved file is damaged at a joint"); }

    std::vector<double> flat;

private:
    void one(double& number) {
        if (!back_) return flat.push_back(number);
        if (next_ == flat.size()) damaged();
        number = flat[next_++];
    }
    bool back_;
    std::size_t next_ = 0;
};

void exchange(Numbers& n, JointReference& r) {
    n(r.normal);
    n(r.tangent);
    auto corners = r.polygon();
    n.list(corners);
    if (corners != r.polygon()) r.corners = std::make_shared<Polygon>(std::move(corners));
    for (auto& side : r.sides) {
        n(side.body);
        n(side.position);
        n(side.orientation);
        n(side.shearShare);
    }
    n(r.refined);
    int handed = r.handed;
    n(handed);
    r.handed = handed != 0;
    auto coarse = r.coarse ? *r.coarse : std::vector<JointPoint>();
    n.list(coarse);
    if (!r.coarse && !coarse.empty()) r.coarse = std::make_shared<std::vector<JointPoint>>(std::move(coarse));
    std::vector<Attachment> none;
    for (int side = 0; side < 2; ++side)
        n.list(r.attached ? r.attached->sides[side] : none);
}

} // namespace

std::vector<double> MasonryJointGeom::record() {
    if (!group) return {};
    shapes();
    Numbers n(false);
    int count = group->points;
    n(count);
    exchange(n, group->joints[index]);
    double fields[JointShapes::numbersOfFields];
    group->readFields(index, fields);
    for (double& number : fields)
        n(number);
    for (int p = 0; p < count; ++p) {
        Vector3r offsetOfPoint = offset(p), jumpOfPoint = jump(p), viscous = group->viscousAt(p, index);
        auto impact = group->impactAt(p, index);
        double areaOfPoint = area(p);
        n(offsetOfPoint);
        n(areaOfPoint);
        n(jumpOfPoint);
        n(viscous);
        n(impact.stress);
        n(impact.closing);
    }
    return n.flat;
}

void MasonryJointGeom::setRecord(const std::vector<double>& flat) {
    if (flat.empty()) return;
    Numbers n(true, flat);
    int count = 0;
    n(count);
    if (count < 0 || std::size_t(count) > flat.size()) Numbers::damaged();
    const shared_ptr<JointShapes> made(new JointShapes(1, count));
    if (group) made->joints[0].attached = reference().attached;
    exchange(n, made->joints[0]);
    double fields[JointShapes::numbersOfFields];
    for (double& number : fields)
        n(number);
    made->writeFields(0, fields);
    for (int p = 0; p < count; ++p) {
        Vector3r offsetOfPoint = Vector3r::Zero(), jumpOfPoint = Vector3r::Zero(), viscous = Vector3r::Zero();
        JointShapes::Impact impact;
        double areaOfPoint = 0;
        n(offsetOfPoint);
        n(areaOfPoint);
        n(jumpOfPoint);
        n(viscous);
        n(impact.stress);
        n(impact.closing);
        made->setViscous(p, 0, viscous);
        made->setImpact(p, 0, impact);
        made->setShape(p, 0, offsetOfPoint, areaOfPoint);
        made->setJump(p, 0, jumpOfPoint);
    }
    group = made;
    index = 0;
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
