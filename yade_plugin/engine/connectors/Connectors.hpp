// SPDX-License-Identifier: GPL-2.0-or-later
// What connects bodies beside their joints: ties and springs, each kind in columns, from which an engine derives.
#pragma once
#include "engine/joints/SceneContents.hpp"

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
    // Stiffness of a connector between its ends along the global axes [N/m] and about them [N m] for the time step:
    // never too small.
    virtual Vector3r stiffnessOf(int connector) const = 0;
    virtual Vector3r rotationalStiffnessOf(int connector) const = 0;

    // What files show of a connector, as the last step left it.
    struct View {
        Vector3r force = Vector3r::Zero(); // on its first body [N]
        double tension = 0;                // along the line between its ends; 0 for what has no such line [N]
        double elongation = 0;             // of that line [m]
        int condition = 0;                 // 0 elastic, 1 has yielded, 2 broken
    };
    virtual View view(const SceneContents&, int connector) const = 0;
    // Whether ends stand apart, so that a connector is a line; else it is a point.
    virtual bool isBar() const = 0;

    // The attributes that all kinds have.
    template <class Class, class Visit> static void describe(Visit&& visit) {
        visit("bodies1", &Class::bodies1, described("Body of the first end of each connector; -1: the ground"), Given);
        visit("points1", &Class::points1,
              described("Place of the first end in the reference state of its body, global axes [m]"), Given);
        visit("bodies2", &Class::bodies2, described("Body of the second end of each; -1: the ground"), Given);
        visit("points2", &Class::points2, described("Place of the second end, likewise [m]"), Given);
        visit("elastic", &Class::stored, number("J", "Elastic energy in the last step"), ReadOnly);
        visit("dissipated", &Class::dissipated, number("J", "Dissipated energy so far"), ReadOnly);
        visit("given", &Class::given, number("J", "Work of tightening so far"), ReadOnly);
    }

    // Throws std::invalid_argument if an end is on a body that is not there or that is a deformable unit.
    void checkBodies(const SceneContents&) const;

    // An end of a connector in the present step.
    struct End {
        Vector3r place; // [m]
        Vector3r arm;   // from the centre of its body [m]
    };
    static End endOf(const SceneContents&, int body, const Vector3r& point);

protected:
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
