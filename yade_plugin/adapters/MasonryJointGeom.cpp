#include "MasonryJointGeom.hpp"
#include "SceneCheck.hpp"
#include "common/Text.hpp"
#include <algorithm>

BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryJointGeom)
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::Ig2_Polyhedra_Polyhedra_MasonryJointGeom)

namespace masonry {

void MasonryJointGeom::define(const FaceContact& face, const Vector3r& alongDirection, int columns, int rows,
                              const yade::State& state1, const yade::State& state2) {
    normal = face.normal, tangent = alongDirection;
    polygon = face.polygon;
    position1 = state1.pos, position2 = state2.pos;
    orientation1 = state1.ori, orientation2 = state2.ori;
    const Quaternionr reference(referenceAxes());
    frame1 = orientation1.conjugate() * reference, frame2 = orientation2.conjugate() * reference;
    points.clear();
    for (const auto& cell : subdivide(polygon, normal, tangent, columns, rows)) {
        JointPoint point;
        point.offset = referenceAxes().transpose() * (cell.centre - position1);
        point.area = cell.area;
        points.push_back(point);
    }
    centreToCentre = referenceAxes().transpose() * (position2 - position1);
    distance1 = (polygon[0] - position1).dot(normal);
    distance2 = (position2 - polygon[0]).dot(normal);
}

std::vector<Polygon> MasonryJointGeom::cells() const {
    std::vector<Point> around;
    for (const auto& point : points)
        around.push_back(centre(point));
    return nearestCells(polygon, around);
}

// Each body carries the joint's axes along; the mean of both is the frame of the joint, and `half` turns it to body 2's
// place as its inverse does to body 1's. In that frame a point at offset a from body 1's centre shows the jump
// between - half d + (half - half^T) a, d from centre to centre in the reference state, and half - half^T = 4 w [v ×]
// for the unit quaternion (w, v). Forces act at the middle of the jump and the axes turn with the mean rotation:
// together this keeps both angular momentum and the power of the joint.
void MasonryJointGeom::update(const yade::State& state1, const yade::State& state2) {
    if (zones) return updateDeformable(state1, state2);
    const Quaternionr by1 = state1.ori * frame1;
    Quaternionr by2 = state2.ori * frame2;
    if (by1.dot(by2) < 0) by2.coeffs() *= -1; // a quaternion and its negative are the same rotation
    const Quaternionr mean = Quaternionr((by1.coeffs() + by2.coeffs()).eval()).normalized();
    const Quaternionr half = mean.conjugate() * by2;
    axes = mean.toRotationMatrix();
    between = state2.pos - state1.pos;

    const Vector3r v = half.vec(), twist = 4 * half.w() * v, twice = 2 * v;
    const Vector3r turned = twice.cross(centreToCentre); // half d = d + w (2v × d) + v × (2v × d)
    const Vector3r common = axes.transpose() * between - (centreToCentre + half.w() * turned + v.cross(turned));
    const double shrink = 1 - 2 * v.squaredNorm();
    for (auto& point : points) {
        const Vector3r jump = common + twist.cross(point.offset), step = jump - point.jump;
        point.jump = jump;
        point.increment = {step[0], {step[1], step[2]}};
        point.arm = shrink * point.offset + v.dot(point.offset) * twice + 0.5 * common; // half^T a + jump / 2
    }
}

// The same frame, with each side's displacement from its nodes or, where it is rigid, from its body.
void MasonryJointGeom::updateDeformable(const yade::State& state1, const yade::State& state2) {
    const Quaternionr by1 = state1.ori * frame1;
    Quaternionr by2 = state2.ori * frame2;
    if (by1.dot(by2) < 0) by2.coeffs() *= -1;
    axes = Quaternionr((by1.coeffs() + by2.coeffs()).eval()).normalized().toRotationMatrix();
    between = state2.pos - state1.pos;
    const auto moved = [](const yade::State& s, const Vector3r& position, const Quaternionr& orientation,
                          const Vector3r& point) {
        return Vector3r(s.pos + s.ori * (orientation.conjugate() * (point - position)) - point);
    };
    const yade::Matrix3r reference = referenceAxes();
    zones->units();
    for (std::size_t i = 0; i < points.size(); ++i) {
        auto& point = points[i];
        const Vector3r place = position1 + reference * point.offset;
        const Vector3r u1 = attachments1.empty() ? moved(state1, position1, orientation1, place)
                                                 : zones->displacementAt(attachments1[i]);
        const Vector3r u2 = attachments2.empty() ? moved(state2, position2, orientation2, place)
                                                 : zones->displacementAt(attachments2[i]);
        const Vector3r gap = u2 - u1, jump = axes.transpose() * gap, step = jump - point.jump;
        point.jump = jump;
        point.increment = {step[0], {step[1], step[2]}};
        const bool rigid1 = attachments1.empty(); // the arm at the rigid side, if there is one
        point.arm = axes.transpose() * (rigid1 ? Vector3r(place + u1 - state1.pos) : Vector3r(place + u2 - state2.pos));
    }
}

void MasonryJointGeom::attach(const shared_ptr<MasonryZones>& all, int id1, int id2) {
    const auto *unit1 = all->unitOf(id1), *unit2 = all->unitOf(id2);
    if (!unit1 && !unit2) return;
    zones = all, body1 = id1, body2 = id2;
    using Nodes = std::vector<std::pair<int, double>>;
    const Nodes nodes1 = unit1 ? all->nodesOn(*unit1, polygon, normal) : Nodes{};
    const Nodes nodes2 = unit2 ? all->nodesOn(*unit2, polygon, normal) : Nodes{};
    const double close = 1e-3 * (polygon[2] - polygon[0]).norm();
    std::vector<JointPoint> atNodes;
    std::vector<Attachment> side1, side2;
    const auto& lead = unit1 ? nodes1 : nodes2; // node to node, areas the mean of both sides
    for (const auto& [node, part] : lead) {
        const Vector3r place = all->reference(unit1 ? *unit1 : *unit2, node);
        JointPoint point;
        point.offset = referenceAxes().transpose() * (place - position1);
        point.area = part;
        Attachment mine;
        mine.nodes.fill(node);
        (unit1 ? side1 : side2).push_back(mine);
        if (unit1 && unit2) {
            const auto twin = std::find_if(nodes2.begin(), nodes2.end(), [&](const auto& other) {
                return (all->reference(*unit2, other.first) - place).norm() < close;
            });
            if (twin == nodes2.end()) break;
            point.area = 0.5 * (part + twin->second);
            mine.nodes.fill(twin->first);
            side2.push_back(mine);
        }
        atNodes.push_back(point);
    }
    const bool matching =
        !lead.empty() && atNodes.size() == lead.size() && (!unit1 || !unit2 || nodes1.size() == nodes2.size());
    if (matching)
        points = atNodes, attachments1 = side1, attachments2 = side2;
    else
        for (const auto& point : points) {
            if (unit1) attachments1.push_back(all->attach(*unit1, centre(point)));
            if (unit2) attachments2.push_back(all->attach(*unit2, centre(point)));
        }
}

ConvexBlock blockOf(yade::Polyhedra& shape, const Vector3r& position, const Quaternionr& orientation) {
    ConvexBlock block;
    const auto corners = shape.GetSurfaceTriangulation();
    for (const auto& v : shape.v)
        block.vertices.push_back(position + orientation * v);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        std::array<int, 3> t{corners[i], corners[i + 1], corners[i + 2]};
        const auto &a = block.vertices[t[0]], &b = block.vertices[t[1]], &c = block.vertices[t[2]];
        if ((b - a).cross(c - a).dot(a - position) < 0) std::swap(t[1], t[2]); // outward from the centre
        block.triangles.push_back(t);
    }
    return block;
}

void Ig2_Polyhedra_Polyhedra_MasonryJointGeom::postLoad() {
    std::vector<std::string> wrong;
    const auto count = [&](const char* what, int n) {
        if (n < 1 || n > 1000) wrong.push_back(std::string(what) + " " + std::to_string(n) + " must be 1 to 1000");
    };
    count("subcontacts", subcontacts);
    count("rows", rows);
    if (!(tolerance > 0 && tolerance <= 0.01))
        wrong.push_back("tolerance " + text(tolerance) + " must be above 0 and at most 0.01");
    if (!rowDirection.allFinite()) wrong.push_back("rowDirection must be finite numbers");
    if (!wrong.empty()) throw std::invalid_argument(std::string(className) + ": " + joined(wrong, "; "));
}

bool Ig2_Polyhedra_Polyhedra_MasonryJointGeom::go(const shared_ptr<yade::Shape>& shape1,
                                                  const shared_ptr<yade::Shape>& shape2, const yade::State& state1,
                                                  const yade::State& state2, const Vector3r&, const bool& force,
                                                  const shared_ptr<yade::Interaction>& interaction) {
    if (!interaction->geom) {
        const auto face =
            coincidentFaces(blockOf(static_cast<yade::Polyhedra&>(*shape1), state1.pos, state1.ori),
                            blockOf(static_cast<yade::Polyhedra&>(*shape2), state2.pos, state2.ori), tolerance);
        if (!face) {
            if (!force) return false;
            throw std::invalid_argument(
                "bodies " + std::to_string(interaction->id1) + " and " + std::to_string(interaction->id2) +
                " share no face: no joint can be made (tolerance " + text(tolerance) + " of the smaller block's size)");
        }
        const Vector3r across = rowDirection - rowDirection.dot(face->normal) * face->normal;
        const bool given = across.norm() > 1e-6 * rowDirection.norm();
        const Vector3r along = given ? Vector3r(across.cross(face->normal).normalized()) : longestEdge(face->polygon);
        const shared_ptr<MasonryJointGeom> geom(new MasonryJointGeom);
        geom->define(*face, along, subcontacts, rows, state1, state2);
        if (zones) geom->attach(zones, interaction->id1, interaction->id2);
        interaction->geom = geom;
    }
    auto& geom = static_cast<MasonryJointGeom&>(*interaction->geom);
    if (geom.keeper) geom.keeper->release(); // a MasonryJointLoop that no longer runs
    geom.update(state1, state2);
    return true;
}

namespace {

struct Candidate {
    int id;
    KnownBlock block;
    Vector3r low, high; // of the space in which it may touch others
    std::vector<int> joined;
};

// All blocks of the scene; std::invalid_argument with all that is wrong with them.
std::vector<Candidate> candidates(double tolerance) {
    if (!(tolerance > 0 && tolerance <= 0.01))
        throw std::invalid_argument("tolerance " + text(tolerance) + " must be above 0 and at most 0.01");
    std::vector<Candidate> all;
    std::vector<std::string> wrong;
    for (const auto& body : Singleton<yade::Omega>::instance().getScene()->bodies->body) {
        auto* shape = body ? dynamic_cast<yade::Polyhedra*>(body->shape.get()) : nullptr;
        if (!shape) continue;
        const auto found = problemsOf(*body);
        wrong.insert(wrong.end(), found.begin(), found.end());
        if (!found.empty()) continue;
        const auto& s = *body->state;
        Candidate c{
            body->id, blockOf(*shape, s.pos, s.ori), Vector3r::Constant(HUGE_VAL), Vector3r::Constant(-HUGE_VAL), {}};
        const double size = c.block.diagonal, away = (s.pos - s.refPos).norm();
        if (away > tolerance * size)
            wrong.push_back("body " + std::to_string(body->id) + " lies " + text(1e3 * away) +
                            " mm from its reference place state.refPos, which addBlock() sets");
        for (const auto& v : c.block.vertices)
            c.low = c.low.cwiseMin(v), c.high = c.high.cwiseMax(v);
        const Vector3r margin = Vector3r::Constant(std::max(tolerance * size, 0.125 * c.block.thickness));
        c.low -= margin, c.high += margin;
        all.push_back(std::move(c));
    }
    if (!wrong.empty()) throw std::invalid_argument(firstOf(wrong));
    return all;
}

} // namespace

py::tuple neighbours(double tolerance) {
    auto all = candidates(tolerance);
    Vector3r low = Vector3r::Constant(HUGE_VAL), high = -low;
    for (const auto& c : all)
        low = low.cwiseMin(c.low), high = high.cwiseMax(c.low);
    int axis; // along which the blocks are spread most
    (high - low).maxCoeff(&axis);
    std::sort(all.begin(), all.end(), [axis](const auto& a, const auto& b) { return a.low[axis] < b.low[axis]; });
    using Pair = std::pair<int, int>;
    std::vector<Pair> pairs;
    std::vector<std::tuple<std::size_t, std::size_t, Misfit>> misfits;
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = i + 1; j < all.size() && all[j].low[axis] <= all[i].high[axis]; ++j) {
            auto &one = all[i], &two = all[j];
            if ((two.low.array() > one.high.array()).any() || (one.low.array() > two.high.array()).any()) continue;
            if (coincidentFaces(one.block, two.block, tolerance)) {
                pairs.emplace_back(std::minmax(one.id, two.id));
                one.joined.push_back(int(j)), two.joined.push_back(int(i));
            } else if (const auto found = misfit(one.block, two.block, tolerance))
                misfits.emplace_back(i, j, *found);
        }
    std::sort(pairs.begin(), pairs.end());
    std::vector<std::tuple<Pair, double, double>> gaps;
    for (const auto& [i, j, found] : misfits) {
        const auto filled = [&, &others = all[j].joined, &middle = found.middle](int k) { // by a block joined to both
            return std::count(others.begin(), others.end(), k) &&
                   all[k].block.holds(middle, 1e-3 * all[k].block.thickness);
        };
        if (found.gap < 0 || std::none_of(all[i].joined.begin(), all[i].joined.end(), filled))
            gaps.emplace_back(std::minmax(all[i].id, all[j].id), found.gap,
                              tolerance * std::min(all[i].block.diagonal, all[j].block.diagonal));
    }
    std::sort(gaps.begin(), gaps.end());
    py::list touching, missing, sizes;
    for (const auto& [one, two] : pairs)
        touching.append(py::make_tuple(one, two));
    for (const auto& [ids, gap, bound] : gaps)
        missing.append(py::make_tuple(ids.first, ids.second, gap, bound));
    if (!all.empty()) {
        const auto thin = std::min_element(
            all.begin(), all.end(), [](const auto& a, const auto& b) { return a.block.thickness < b.block.thickness; });
        const auto large = std::max_element(
            all.begin(), all.end(), [](const auto& a, const auto& b) { return a.block.diagonal < b.block.diagonal; });
        sizes.append(py::make_tuple(thin->id, thin->block.thickness));
        sizes.append(py::make_tuple(large->id, large->block.size()));
    }
    return py::make_tuple(touching, missing, sizes);
}

py::list touchingPairs(double tolerance) { return py::extract<py::list>(neighbours(tolerance)[0]); }

} // namespace masonry
