// SPDX-License-Identifier: GPL-2.0-or-later
// More points for joints between rigid blocks whose cap is about to yield. What a joint does before its toe crushes,
// few points along it say exactly or nearly so; where crushing begins and how far it reaches, only many do. README.md,
// Points where the toe crushes, says what the new points take over.
#pragma once
#include "SceneStore.hpp"

namespace masonry {

class Refinement {
public:
    static constexpr int every = 10; // steps between two looks
    static constexpr double share =
        0.9; // of the elastic limit of the cap, or of the strength, at which a joint gets its points
    static constexpr double company = 0.75; // the same of joints that get theirs when another does: reading all joints
                                            // of a scene again takes as long as some dozen steps
    static constexpr int fewest = 3;        // points in a row that have the true rotational stiffness
    static constexpr int most = 100;        // points along a joint

    // Refines the joints of a scene that are about to yield, as JointLoop::refinement says, if this is a step to look
    // at them. Throws std::invalid_argument if joints of the scene cannot be refined.
    void look(SceneStore&);
    // After the joints have made their step: counts what joints that were refined before it give or take by the forces
    // of the step before, half of which act along this one.
    void count(SceneStore&);

    // Gives the joints of a scene the numbers of points along them in `refined`, one number a joint in the store's
    // order; 0 stands for the points that a joint was made with. The state of a joint whose points change is that of a
    // new one. Returns false, and changes nothing, if a joint cannot have these points.
    static bool setPoints(SceneStore&, const std::vector<double>& refined);

private:
    // Stresses of a kind of joints at which one of them gets its points: near the elastic limit of the cap, or, of
    // joints that cannot crush, near the first yield.
    class Limit {
    public:
        explicit Limit(const LawColumns&);
        bool isNeeded() const { return crushes_ || cracks_; }
        bool cracks() const { return cracks_; }
        bool isReached(double part, double normalStress, double shearStressA, double shearStressB) const;

    private:
        bool yields(double normalStress, double shearStressA, double shearStressB) const;

        const LawColumns* columns_;
        bool crushes_ = false, cracks_ = false;
        double normal_ = 0, shear_ = 0, linear_ = 0; // shape of the cap, Cnn, Css [-] and Cn [Pa]
        double elasticLimit_ = 0;                    // of the cap [Pa]
        // Of joints that cannot crush: normal and shear stress [Pa] up to which the law need not be called.
        double tension_ = 0, slip_ = 0;
    };
    void readLimits(const SceneStore&);
    void check(const SceneStore&, int points);
    bool isDue(const JointKind&, const Limit&, double part, int joint) const;

    // A joint that was refined in this step, with the forces at a row of points before and after that.
    struct Changed {
        JointView joint;
        struct Force {
            double place;   // along the row [m]
            Vector3r force; // at the points that there were, less that at the new ones, in the joint's axes [N]
        };
        std::vector<Force> forces;
        int along;
        std::vector<Vector3r> jumps; // of the new points before the step [m]
    };

    std::vector<Changed> changed_;
    std::vector<Limit> limits_; // of the store's kinds
    long revision_ = -1;        // SceneContents::revision() for which they were read
    int checkedPoints_ = 0;     // number of points for which the scene was checked
};

} // namespace masonry
