// What a program needs of any joint law. A law is made of the properties of one kind of joint and keeps no state.
#pragma once
#include "CompressionCurve.hpp"
#include "JointProperties.hpp"
#include "JointState.hpp"
#include "SofteningTable.hpp"
#include <memory>
#include <string>
#include <vector>

namespace masonry {

class LawColumns;

// The yield functions at a state; at most zero after every step. `cap` is -1 where the cap does not act, all are where
// no strength is ever reached.
struct Yield {
    double tension, slip, cap; // [Pa], [Pa], [Pa²]
};

class Law : public std::enable_shared_from_this<Law> {
public:
    virtual ~Law() = default;

    // The law that properties ask for. Throws std::invalid_argument with all their problems at once.
    static std::shared_ptr<const Law> of(const JointProperties&);

    virtual const JointProperties& properties() const = 0;
    virtual const SofteningTable& tension() const = 0; // in use, given or made of the fracture energy
    virtual const SofteningTable& shear() const = 0;
    virtual const CompressionCurve& compression() const = 0;

    virtual Yield yield(const ElasticStiffness&, const JointState&) const = 0;
    // Compression damage dc, eq. (21).
    virtual double compressionDamage(const ElasticStiffness&, const JointState&) const = 0;

    // What is wrong with this joint between rigid units that make it show the stiffness k: a softening branch that
    // would snap back. A sentence each. `distance` [m] is that of the units' centroids, so far as it is lumped into k.
    virtual std::vector<std::string> snapsBack(const ElasticStiffness& k, double distance) const = 0;

    // Columns for the states of joints of this kind. The law must be held by a shared pointer.
    virtual std::unique_ptr<LawColumns> columns(const ElasticStiffness&, int joints, int points) const = 0;
};

} // namespace masonry
