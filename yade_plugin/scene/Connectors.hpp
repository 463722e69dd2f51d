// SPDX-License-Identifier: GPL-2.0-or-later
// What connects bodies beside their joints: ties and springs, each kind in columns. An engine derives from each kind.
#pragma once
#include "SceneContents.hpp"

namespace masonry {

using yade::Vector3r;

class Connectors {
public:
    static constexpr int ground = -1; // in place of the id of a body: what never moves

    virtual ~Connectors() = default;

    // Of every connector, its two ends: a body, or the ground, and a point of it in the reference state, global axes
    // [m].
    std::vector<int> bodies1, bodies2;
    std::vector<Vector3r> points1, points2;

    double given = 0;      // work that tightening has done on the connectors so far [J]
    double stored = 0;     // their elastic energy in the last step [J]
    double dissipated = 0; // what they have dissipated so far [J]

    int count() const { return int(bodies1.size()); }
    // Adds the forces of all connectors to those of the present step, and counts their energies.
    virtual void act(SceneContents&) = 0;
    // Stiffness of a connector between its ends along the global axes [N/m] and about them [N m], as far as it matters
    // for the time step: never too small.
    virtual Vector3r stiffnessOf(int connector) const = 0;
    virtual Vector3r rotationalStiffnessOf(int connector) const = 0;

    // Throws std::invalid_argument if an end is on a body that is not there or that is a deformable unit.
    void checkBodies(const SceneContents&) const;

protected:
    // An end of a connector in the present step.
    struct End {
        Vector3r place; // [m]
        Vector3r arm;   // from the centre of its body [m]
    };
    static End endOf(const SceneContents&, int body, const Vector3r& point);
    // How far a body has turned since the reference state: a vector along the axis [rad]; zero for the ground.
    static Vector3r turnOf(const SceneContents&, int body);
    // What is wrong with the ends, one sentence for each problem.
    std::vector<std::string> problemsOfEnds() const;
    // Says that a column has not as many values as there are connectors, or that one is out of bounds.
    static void check(std::vector<std::string>& problems, const char* name, const std::vector<double>& column,
                      int count, const Property& property);
    template <class T> static void fit(std::vector<T>& column, int count, const T& value) {
        if (int(column.size()) != count) column.resize(std::size_t(count), value);
    }
};

} // namespace masonry
