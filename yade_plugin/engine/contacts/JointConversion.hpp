// SPDX-License-Identifier: GPL-2.0-or-later
// Which joints are handed over to contact, and what they leave behind. A joint is for small displacements: it acts at
// points of the reference state. Where its bond is gone and its blocks have moved far against each other, the contact
// of the two blocks takes its place (engine/contacts/Contacts).
#pragma once
#include "Contacts.hpp"
#include "engine/joints/SceneContents.hpp"

namespace masonry {

class JointConversion {
public:
    // How far the blocks of a joint without bond may move before it is handed over.
    static constexpr double slide = 0.02; // mean slide over the size of the joint in that direction [-]
    // Rotation of both blocks against each other since the reference state: 1° [rad].
    static constexpr double turn = 0.017453292519943295;
    // Rotation from which on the bond of closed points does not count, which are the edge that the block turns about:
    // 5° [rad]. There the lever arms of the reference state are off by 0.4 %.
    static constexpr double hingeTurn = 0.08726646259971647;
    static constexpr double opening =
        0.02; // smallest opening over the larger size of the joint [-]: beyond it a bond does not count

    // Hands over the joints between rigid blocks that are due, when all forces of the step are there.
    void act(SceneContents&, Contacts&);

private:
    struct Size {
        double along, across;   // extents of the polygon along the joint's two tangents [m]
        yade::Quaternionr back; // rotation from block 2 to block 1 in the reference state
        bool bonded;            // whether the law has a bond at all
    };
    void measure(const SceneContents&);
    std::vector<JointView> due(const SceneContents&); // in the host's order
    // Takes the forces from a joint (LawColumns::release). Returns the elastic energy that it had [J].
    static double release(const JointView&);
    bool isDue(const SceneContents&, const JointView&, const Size&) const;

    long revision_ = -1;      // SceneContents::stiffnessRevision() for which they were measured
    std::vector<Size> sizes_; // of the joints of SceneContents, in its order
};

} // namespace masonry
