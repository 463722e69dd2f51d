// SPDX-License-Identifier: GPL-2.0-or-later
// More points for joints between rigid blocks that are about to yield or, dry and compliant, to open. While a joint is
// elastic and closed, few points along it say exactly what it does; how far crushing, a crack or the pressed part of an
// open joint reaches, only many do. yade_plugin/README.md, Points where a joint yields, says when, and what
// the new points take over.
#pragma once
#include "SceneContents.hpp"
#include <Eigen/Geometry>
#include <map>
#include <set>

namespace masonry {

class Refinement {
public:
    static constexpr int every = 10; // steps between two looks
    // Part of the elastic limit of the cap, of the strength, or of the lever of the force at which an end opens, at
    // which a joint gets its points.
    static constexpr double share = 0.9;
    // The part at which joints get theirs when another does: reading all joints of a scene again takes as long as some
    // dozen steps.
    static constexpr double company = 0.75;
    // Points that a joint gets whose points stand in a row, unless JointLoop::points says.
    static constexpr int pointsOfRow = 8;
    static constexpr int pointsOfSide = 5; // the same along each side of a joint in space
    // Points that a dry joint gets along the side along which it opens; the other side keeps `fewest`.
    static constexpr int pointsOfOpening = 14;
    static constexpr int pointsOfBoth = 8; // along both sides of a joint that opens along both
    static constexpr double both = 0.25;   // share of one side in the other from which on it opens along both
    static constexpr int pointsOfFan = 6;  // of a face in space that has not four corners
    // Least lean of a compliant structure: the displacement of its top over its width, if its beds turned as they do
    // where one end of its section is about to open.
    static constexpr double leastLean = 1e-3;
    static constexpr int fewest = 3; // points along a side that have the true rotational stiffness
    static constexpr int most = 100; // points along a side

    // Refines the joints of a scene that are about to yield or to open, as JointLoop::points says, if this is a step to
    // look at them. Joints with fewer than three points along a side keep them. Returns whether joints got points:
    // SceneStore must then read them again.
    bool look(SceneContents&);
    // After the joints have made their step: counts what joints that were refined before it give or take by the forces
    // of the step before, half of which act along this one.
    void count(SceneContents&);

    // Gives the joints of a scene the numbers of points in `refined`, one entry a joint in the store's order; 0 stands
    // for the points that a joint was made with. The state of a joint whose points change is that of a
    // new one, and SceneStore must read the joints again. Returns false, and changes nothing, if a joint cannot have
    // these points.
    static bool setPoints(SceneContents&, const std::vector<PointCounts>& refined);

private:
    // Stresses of a kind of joints at which one of them gets its points: near the elastic limit of the cap, and, of
    // joints in space and of those that cannot crush, near the first yield of the bond.
    class Limit {
    public:
        Limit(const JointKind&, int wanted);
        // Points that a joint gets when it yields, and when one of its ends opens along the first side; 0: it keeps
        // those that it has.
        const PointCounts& yielded() const { return yielded_; }
        const PointCounts& opened() const { return opened_; }
        bool row() const { return row_; } // whether points stand in a row
        bool dry() const { return dry_; }
        bool opens() const { return opens_; } // whether the joint is dry or can become so
        bool cracks() const { return cracks_; }
        bool isReached(double part, double normalStress, double shearStressA, double shearStressB) const;

    private:
        bool yields(double normalStress, double shearStressA, double shearStressB) const;

        const LawColumns* columns_;
        PointCounts yielded_, opened_;
        bool row_ = false, dry_ = false, opens_ = false;
        double elasticLimit_ = 0; // in compression [Pa]; 0: none
        bool cracks_ = false;     // whether the limits of its bond count
        // Normal and shear stress [Pa] of the bond up to which the law need not be called.
        double tension_ = 0, slip_ = 0;
    };
    void readLimits(const SceneContents&);
    bool yields(const JointKind&, const Limit&, double part, int joint) const;
    static bool hasCracked(const JointShapes&, int joint);
    PointCounts countsIfOpening(SceneContents&, const JointKind&, const Limit&, double part, int joint);
    PointCounts countsIfDue(SceneContents&, const JointKind&, const Limit&, double part, int joint);
    void readParts(const SceneContents&);
    bool isBridged(const JointReference&) const;
    double extentOf(const JointReference&, int axis) const;
    double widthOf(const SceneContents&, const JointReference&, int axis);

    // A joint that was refined in this step, with the forces at its points before and after that.
    struct Changed {
        JointView joint;
        struct Force {
            Vector3r place; // offset of a point [m]
            Vector3r force; // at the points that there were, less that at the new ones, in the joint's axes [N]
        };
        std::vector<Force> forces;
        std::vector<Vector3r> jumps; // of the new points before the step [m]
    };

    std::vector<Changed> changed_;
    std::vector<Limit> limits_;                               // of the store's kinds
    long revision_ = -1;                                      // SceneContents::revision() for which they were read
    int points_ = 0;                                          // JointLoop::points for which they were read
    std::vector<int> partOf_;                                 // part of each body, -1 if it is held
    std::map<int, Eigen::AlignedBox3d> sizes_;                // around the joints of each part
    std::map<std::pair<const Polygon*, int>, double> widths_; // see widthOf(), by the joint and the axis
    std::vector<std::vector<std::pair<int, const JointGeometry*>>> bonds_; // of each body with others
    struct Place {                                                         // of a joint
        Vector3r normal;
        Eigen::AlignedBox3d box;
        int bodies[2];
    };
    std::vector<Place> places_;   // of the store's joints, side by side in memory for widthOf()
    long stiffnessRevision_ = -1; // SceneContents::stiffnessRevision() for which these five were read
};

} // namespace masonry
