// SPDX-License-Identifier: GPL-2.0-or-later
#include "Gl1_MasonryJointPhys.hpp"
#include "Colours.hpp"
#include "engine/store/SceneStore.hpp"
#include <GL/gl.h>
#include <algorithm>
#include <unordered_map>

MASONRY_DEFINE(Gl1_MasonryJointPhys)

namespace masonry {

namespace {

using JointDrawer = Gl1_MasonryJointPhys;

double largestOpening = 0; // of the openings that were drawn since the settings changed

// A joint as it is drawn: the polygons of its subcontacts at their places, and the value of each.
struct Drawing {
    std::vector<Polygon> cells; // in the reference state
    std::vector<double> values;
    Vector3r motions[2]; // of the two bodies: displacement of the centre [m]
    yade::Matrix3r turns[2];
    bool drawn = false;
};

// All joints of a scene at one time. YADE asks for one after the other while the run may go on in the background: the
// state of all is read at once, between two steps, when a joint is asked for a second time.
class Picture {
public:
    Drawing* of(const yade::IPhys* phys) {
        auto found = drawings_.find(phys);
        if (found == drawings_.end() || found->second.drawn) {
            read();
            found = drawings_.find(phys);
        }
        return found == drawings_.end() ? nullptr : &found->second;
    }

private:
    void read() {
        const BetweenSteps still;
        auto& store = SceneStore::present();
        store.update();
        if (&store != store_ || store.revision() != revision_) drawings_.clear();
        store_ = &store;
        revision_ = store.revision();
        for (const auto& joint : store.joints) {
            auto& drawing = drawings_[joint.interaction->phys.get()];
            const auto& r = joint.geom->reference();
            if (drawing.cells.empty()) drawing.cells = joint.geom->cells();
            for (int side = 0; side < 2; ++side) {
                const auto& s = store.bodies.state(r.sides[side].body);
                drawing.motions[side] = s.pos - r.sides[side].position;
                drawing.turns[side] = (s.ori * r.sides[side].orientation.conjugate()).toRotationMatrix();
            }
            drawing.values.clear();
            for (int p = 0; p < joint.phys->points(); ++p) {
                const auto s = joint.phys->state(p);
                const auto shown = [&](const JointField& field) {
                    return joint.phys->group->columns->shown(p, joint.phys->index, field);
                };
                drawing.values.push_back(JointDrawer::colours == "opening" ? s.opening
                                         : JointDrawer::colours == "regime"
                                             ? double(s.regime)
                                             : std::max({shown(field::damageTension), shown(field::damageShear),
                                                         shown(field::damageCompression)}));
                if (JointDrawer::colours == "opening") largestOpening = std::max(largestOpening, s.opening);
            }
            drawing.drawn = false;
        }
        drawnScales().joints =
            JointDrawer::colours == "regime" ? regimeScale()
            : JointDrawer::colours == "opening"
                ? scaleOf("opening of joints [m]", JointDrawer::most > 0 ? JointDrawer::most : largestOpening, true)
                : scaleOf("damage of joints [-]", 1, true);
    }

    std::unordered_map<const yade::IPhys*, Drawing> drawings_;
    const SceneStore* store_ = nullptr;
    long revision_ = -1;
};
Picture picture;

} // namespace

void Gl1_MasonryJointPhys::postLoad() {
    check();
    largestOpening = 0;
}

std::vector<std::string> Gl1_MasonryJointPhys::problems() const {
    for (const char* choice : {"damage", "opening", "regime"})
        if (colours == choice) return {};
    return {"colours '" + colours + "' must be 'damage', 'opening' or 'regime'"};
}

void Gl1_MasonryJointPhys::go(const shared_ptr<yade::IPhys>& phys, const shared_ptr<yade::Interaction>& interaction,
                              const shared_ptr<yade::Body>&, const shared_ptr<yade::Body>&, bool wire) {
    auto* drawing = picture.of(phys.get());
    const auto* geom = dynamic_cast<const JointGeometry*>(interaction->geom.get());
    if (!drawing || !geom || !geom->made()) return;
    drawing->drawn = true;
    const auto& r = geom->reference();
    // The mean of what both bodies do to a point of the reference state.
    const auto moved = [&](const Vector3r& p) {
        Vector3r both = Vector3r::Zero();
        for (int side = 0; side < 2; ++side) {
            const Vector3r arm = p - r.sides[side].position;
            both += drawing->motions[side] + drawing->turns[side] * arm - arm;
        }
        return Vector3r(p + scale * 0.5 * both);
    };
    glDisable(GL_LIGHTING);
    glDisable(GL_CULL_FACE);
    glLineWidth(4);
    for (std::size_t i = 0; i < drawing->cells.size() && i < drawing->values.size(); ++i) {
        const auto& scale = drawnScales().joints;
        const auto colour = scale.names.empty() ? scale.at(drawing->values[i]) : scale.of(int(drawing->values[i]));
        glColor3fv(colour.data());
        const auto draw = [&](GLenum how) {
            glBegin(how);
            for (const auto& corner : drawing->cells[i]) {
                const Vector3r p = moved(corner);
                glVertex3d(p[0], p[1], p[2]);
            }
            glEnd();
        };
        if (!wire) draw(GL_POLYGON);
        draw(GL_LINE_LOOP); // a joint seen from its side is a line
    }
    glLineWidth(1);
    glEnable(GL_LIGHTING);
}

} // namespace masonry
