// SPDX-License-Identifier: GPL-2.0-or-later
// What a program needs of any joint law. A law is made of the properties of one kind of joint and keeps no state.
#pragma once
#include "CompressionCurve.hpp"
#include "JointProperties.hpp"
#include "SofteningTable.hpp"
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace masonry {

class LawColumns;

class Law : public std::enable_shared_from_this<Law> {
public:
    virtual ~Law() = default;

    const JointProperties& properties() const { return properties_; }

    // Softening tables in use, given or made of the fracture energies, and the curve of the strength in compression. A
    // law that has none leaves them empty.
    virtual const SofteningTable& tension() const;
    virtual const SofteningTable& shear() const;
    virtual const CompressionCurve& compression() const;
    // What stresses make of the elastic limit in compression, squared [Pa²]: they reach it where this is the square of
    // compression().elasticLimit. 0 in a law that does not crush.
    virtual double squaredCapStress(double /*normal*/, double /*squaredShear*/) const { return 0; }

    // What is wrong with this joint between rigid units that make it show the stiffness k: a softening branch that
    // would snap back. A sentence each. `distance` [m] is that of the units' centroids, so far as it is lumped into k.
    virtual std::vector<std::string> snapsBack(const ElasticStiffness& k, double distance) const;

    // Columns for the states of joints of this kind. The law must be held by a shared pointer.
    virtual std::unique_ptr<LawColumns> columns(const ElasticStiffness& k, int joints, int points) const = 0;

protected:
    // Throws WrongProperties with the problems that the law has found, if there are any.
    Law(const JointProperties& properties, std::vector<Problem> problems);

private:
    JointProperties properties_;
};

} // namespace masonry
