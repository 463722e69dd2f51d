// SPDX-License-Identifier: GPL-2.0-or-later
// Linear springs between two bodies, or a body and the ground, along and about the global axes. An engine derives from
// it.
#pragma once
#include "Connectors.hpp"
#include "common/Property.hpp"

namespace masonry {

class Springs : public Connectors {
public:
    std::vector<Vector3r> stiffness;           // along x, y and z [N/m]
    std::vector<Vector3r> rotationalStiffness; // about x, y and z [N m]

    std::vector<Vector3r> forces;  // on the first body in the last step [N]
    std::vector<Vector3r> moments; // on the first body in the last step, about its end [N m]

    std::vector<std::string> problems() const;
    void act(SceneContents&) override;
    Vector3r stiffnessOf(int spring) const override { return stiffness[spring]; }
    Vector3r rotationalStiffnessOf(int spring) const override { return rotationalStiffness[spring]; }
    View view(const SceneContents&, int spring) const override;
    bool isBar() const override { return false; }
};

} // namespace masonry
