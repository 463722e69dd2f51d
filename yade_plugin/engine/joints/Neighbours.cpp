// SPDX-License-Identifier: GPL-2.0-or-later
#include "Neighbours.hpp"
#include "common/Text.hpp"
#include "engine/bodies/Blocks.hpp"
#include "engine/bodies/BodyCheck.hpp"
#include <algorithm>
#include <cmath>

namespace masonry {

namespace py = boost::python;
using yade::Vector3r;

namespace {

struct Candidate {
    int id;
    KnownBlock block;
    Vector3r low, high;      // corners of the box in which it may touch others [m]
    std::vector<int> joined; // numbers of the candidates that share a face with it
};

using Pair = std::pair<int, int>; // ids of two bodies, the lower one first
using SharedFace = SharedFaces::Face;

// All blocks of the present scene. Throws std::invalid_argument that names all problems of these blocks.
std::vector<Candidate> candidates(double tolerance) {
    if (!(tolerance > 0 && tolerance <= 0.01))
        throw std::invalid_argument("tolerance " + text(tolerance) + " must be above 0 and at most 0.01");
    std::vector<Candidate> all;
    std::vector<std::string> wrong;
    for (const auto& body : Singleton<yade::Omega>::instance().getScene()->bodies->body) {
        if (!body || !isBlock(body->shape.get())) continue;
        const auto found = problemsOf(*body);
        wrong.insert(wrong.end(), found.begin(), found.end());
        if (!found.empty()) continue;
        const auto& s = *body->state;
        Candidate c{body->id,
                    blockOf(*body->shape, s.pos, s.ori),
                    Vector3r::Constant(HUGE_VAL),
                    Vector3r::Constant(-HUGE_VAL),
                    {}};
        const double size = c.block.diagonal, away = (s.pos - s.refPos).norm();
        if (away > tolerance * size)
            wrong.push_back("body " + std::to_string(body->id) + " lies " + text(1e3 * away) +
                            " mm from its reference place state.refPos, which addBlock() sets");
        for (const auto& v : c.block.vertices) {
            c.low = c.low.cwiseMin(v);
            c.high = c.high.cwiseMax(v);
        }
        const Vector3r margin = Vector3r::Constant(std::max(tolerance * size, 0.125 * c.block.thickness));
        c.low -= margin;
        c.high += margin;
        all.push_back(std::move(c));
    }
    if (!wrong.empty()) throw std::invalid_argument(firstOf(wrong));
    return all;
}

// What a body has of a face that it shares.
struct Side {
    Vector3r normal, offset; // offset: from the foot of the perpendicular from the body's centre to the middle [m]
    double area, distance;   // distance of the centre from the face [m]
};

// The share of a unit's shear compliance that each of its joints takes (law/README.md, Rigid units): the largest of the
// planes of shear in which it has joints across faces of two directions, more than 45 degrees apart; without any, 1.
double shearShare(const std::vector<Side>& sides) {
    constexpr double youngOverShear = 2.4; // of a Poisson's ratio of 0.2; 0 to 0.35 change the share by 0.03 at most
    const double near = std::sqrt(0.5);
    double share = 0;
    for (auto one = sides.begin(); one != sides.end(); ++one)
        for (auto other = one + 1; other != sides.end(); ++other) {
            const double cosine = one->normal.dot(other->normal);
            if (std::abs(cosine) >= near) continue;
            const Vector3r axes[2] = {one->normal, (other->normal - cosine * one->normal).normalized()};
            double slipping[2] = {0, 0}, opening[2] = {0, 0};
            for (const auto& side : sides)
                for (int a = 0; a < 2; ++a) {
                    if (std::abs(side.normal.dot(axes[a])) <= near) continue;
                    const double off = side.offset.dot(axes[1 - a]);
                    slipping[a] += side.area * side.distance;
                    opening[1 - a] += youngOverShear * side.area * off * off / side.distance;
                }
            const double first = 0.5 * opening[0] / slipping[0], second = 0.5 * opening[1] / slipping[1];
            share = std::max(share, 1 / std::max(1 - first - second + std::hypot(1, first - second), 1.0));
        }
    return share > 0 ? share : 1;
}

std::map<int, double> shearShares(const yade::Scene& scene, const std::vector<SharedFace>& faces) {
    std::map<int, std::vector<Side>> sides; // by body
    for (const auto& [ids, face] : faces)
        for (int id : {ids.first, ids.second}) {
            const Vector3r arm = centroid(face.polygon, face.normal) - scene.bodies->body[id]->state->pos;
            const double along = arm.dot(face.normal);
            sides[id].push_back(
                {face.normal, arm - along * face.normal, area(face.polygon, face.normal), std::abs(along)});
        }
    std::map<int, double> shares;
    for (const auto& [id, own] : sides)
        shares[id] = shearShare(own);
    return shares;
}

} // namespace

py::tuple neighbours(double tolerance, SharedFaces* faces) {
    auto all = candidates(tolerance);
    Vector3r low = Vector3r::Constant(HUGE_VAL), high = -low;
    for (const auto& c : all) {
        low = low.cwiseMin(c.low);
        high = high.cwiseMax(c.low);
    }
    int axis; // the axis along which the blocks spread most; sorted by it, far blocks are never compared
    (high - low).maxCoeff(&axis);
    std::sort(all.begin(), all.end(), [axis](const auto& a, const auto& b) { return a.low[axis] < b.low[axis]; });
    std::vector<SharedFace> shared;
    std::vector<std::tuple<std::size_t, std::size_t, Misfit>> misfits;
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = i + 1; j < all.size() && all[j].low[axis] <= all[i].high[axis]; ++j) {
            auto &one = all[i], &two = all[j];
            if ((two.low.array() > one.high.array()).any() || (one.low.array() > two.high.array()).any()) continue;
            const auto& [lower, higher] = one.id < two.id ? std::tie(one, two) : std::tie(two, one);
            if (auto face = coincidentFaces(lower.block, higher.block, tolerance)) {
                face->polygon.shrink_to_fit();
                shared.push_back({{lower.id, higher.id}, std::move(*face)});
                one.joined.push_back(int(j));
                two.joined.push_back(int(i));
            } else if (const auto found = misfit(one.block, two.block, tolerance))
                misfits.emplace_back(i, j, *found);
        }
    std::sort(shared.begin(), shared.end());
    std::vector<std::tuple<Pair, double, double>> gaps;
    for (const auto& [i, j, found] : misfits) {
        // Whether block k, which is joined to both, fills the gap between them, as a layer of mortar does.
        const auto filled = [&, &others = all[j].joined, &middle = found.middle](int k) {
            return std::count(others.begin(), others.end(), k) &&
                   all[k].block.holds(middle, 1e-3 * all[k].block.thickness);
        };
        if (found.gap < 0 || std::none_of(all[i].joined.begin(), all[i].joined.end(), filled))
            gaps.emplace_back(std::minmax(all[i].id, all[j].id), found.gap,
                              tolerance * std::min(all[i].block.diagonal, all[j].block.diagonal));
    }
    std::sort(gaps.begin(), gaps.end());
    py::list touching, missing, sizes;
    for (const auto& found : shared)
        touching.append(py::make_tuple(found.ids.first, found.ids.second));
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
    if (faces) {
        auto shares = shearShares(*Singleton<yade::Omega>::instance().getScene(), shared);
        *faces = {tolerance, std::move(shared), std::move(shares)};
    }
    return py::make_tuple(touching, missing, sizes);
}

std::optional<FaceContact> SharedFaces::take(int id1, int id2, double wanted) {
    if (tolerance != wanted) return std::nullopt;
    const Pair ids(id1, id2);
    const auto found = std::lower_bound(faces.begin(), faces.end(), ids,
                                        [](const Face& face, const Pair& pair) { return face.ids < pair; });
    if (found == faces.end() || found->ids != ids || found->contact.polygon.empty()) return std::nullopt;
    return FaceContact{found->contact.normal, std::move(found->contact.polygon)};
}

double SharedFaces::shearShareOf(int body) const {
    const auto found = shearShares.find(body);
    return found != shearShares.end() ? found->second : 1;
}

} // namespace masonry
