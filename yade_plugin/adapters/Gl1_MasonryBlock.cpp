// SPDX-License-Identifier: GPL-2.0-or-later
#include "Gl1_MasonryBlock.hpp"
#include "Colours.hpp"
#include "MasonryBlock.hpp"
#include "blocks/FaceContact.hpp"
#include <GL/gl.h>
#include <algorithm>
#include <unordered_map>

MASONRY_DEFINE(Gl1_MasonryBlock)

namespace masonry {

namespace {

using BlockDrawer = Gl1_MasonryBlock;

double largestMotion = 0; // of the values that were drawn since the settings changed

// Colours of materials, by the order in which the scene names them.
const std::vector<Colour> materials = {{0.85f, 0.55f, 0.4f}, {0.55f, 0.65f, 0.75f}, {0.8f, 0.75f, 0.5f},
                                       {0.6f, 0.75f, 0.55f}, {0.75f, 0.6f, 0.75f},  {0.7f, 0.7f, 0.7f}};

// Which material each shape of the present scene has: its number among the names of all materials.
struct Materials {
    std::unordered_map<const yade::Shape*, int> ofShape;
    std::vector<std::string> names;

    void read() {
        ofShape.clear();
        names.clear();
        for (const auto& body : Singleton<yade::Omega>::instance().getScene()->bodies->body) {
            if (!body || !body->shape || !body->material) continue;
            const auto& label = body->material->label;
            const auto known = std::find(names.begin(), names.end(), label);
            ofShape[body->shape.get()] = int(known - names.begin());
            if (known == names.end()) names.push_back(label);
        }
    }
};
Materials known;

ColourScale scaleOfBlocks() {
    const double most = BlockDrawer::most > 0 ? BlockDrawer::most : largestMotion;
    if (BlockDrawer::colours == "displacement") return scaleOf("displacement [m]", most, false);
    if (BlockDrawer::colours == "velocity") return scaleOf("velocity [m/s]", most, false);
    if (BlockDrawer::colours == "material") return {"material", 0, known.names, materials};
    return {};
}

// The colour of a face: that of the legend where it faces the eye, and darker the more it turns away. YADE's lights
// would change all of them.
void show(const Colour& colour, double facing = 1) {
    const auto shade = float(0.7 + 0.3 * facing);
    glColor3f(shade * colour[0], shade * colour[1], shade * colour[2]);
}

void corner(const Vector3r& p) { glVertex3d(p[0], p[1], p[2]); }

} // namespace

void Gl1_MasonryBlock::postLoad() {
    check();
    largestMotion = 0;
}

std::vector<std::string> Gl1_MasonryBlock::problems() const {
    for (const char* choice : {"displacement", "velocity", "material", "own"})
        if (colours == choice) return {};
    return {"colours '" + colours + "' must be 'displacement', 'velocity', 'material' or 'own'"};
}

void Gl1_MasonryBlock::go(const shared_ptr<yade::Shape>& shape, const shared_ptr<yade::State>& state, bool wire,
                          const yade::GLViewInfo&) {
    const auto& block = static_cast<const MasonryBlock&>(*shape);
    const auto& v = block.v;
    const auto& t = block.triangles;
    Colour colour;
    if (colours == "material") {
        if (!known.ofShape.count(shape.get())) known.read();
        const auto number = known.ofShape.find(shape.get());
        drawnScales().blocks = scaleOfBlocks();
        colour = drawnScales().blocks.of(number == known.ofShape.end() ? 0 : number->second);
    } else if (colours == "own") {
        drawnScales().blocks = {};
        for (int c = 0; c < 3; ++c)
            colour[c] = float(shape->color[c]);
    } else {
        const double value = colours == "velocity" ? state->vel.norm() : Vector3r(state->pos - state->refPos).norm();
        largestMotion = std::max(largestMotion, value);
        drawnScales().blocks = scaleOfBlocks();
        colour = drawnScales().blocks.at(value);
    }
    glDisable(GL_LIGHTING);
    if (!wire) {
        double toEye[16]; // column by column
        glGetDoublev(GL_MODELVIEW_MATRIX, toEye);
        glEnable(GL_POLYGON_OFFSET_FILL); // or faces would hide halves of the edges
        glPolygonOffset(1, 1);
        glBegin(GL_TRIANGLES);
        for (std::size_t i = 0; i + 2 < t.size(); i += 3) {
            const Vector3r &a = v[t[i]], &b = v[t[i + 1]], &c = v[t[i + 2]];
            const Vector3r normal = (b - a).cross(c - a).normalized();
            const Vector3r depth(toEye[2], toEye[6], toEye[10]);
            show(colour, std::abs(depth.dot(normal)) / depth.norm());
            for (const auto* p : {&a, &b, &c})
                corner(*p);
        }
        glEnd();
        glDisable(GL_POLYGON_OFFSET_FILL);
    }
    if (!wire && !edges) {
        glEnable(GL_LIGHTING);
        return;
    }
    show(wire ? colour : Colour{0.2f, 0.2f, 0.2f});
    ConvexBlock surface{v, {}};
    for (std::size_t i = 0; i + 2 < t.size(); i += 3)
        surface.triangles.push_back({t[i], t[i + 1], t[i + 2]});
    for (const auto& face : surface.faces()) {
        glBegin(GL_LINE_LOOP);
        for (const auto& p : face)
            corner(p);
        glEnd();
    }
    glEnable(GL_LIGHTING);
}

} // namespace masonry
