// SPDX-License-Identifier: GPL-2.0-or-later
// The properties of one kind of joint, shared by all joints of that kind, with the law that follows from them.
// The class that Python sees derives from it.
#pragma once
#include "engine/bodies/Fixed.hpp"
#include "law/common/Law.hpp"
#include <memory>

namespace masonry {

class PropertySet : public JointProperties {
public:
    virtual ~PropertySet() = default;

    // The law that the property `law` names, with these properties. It is made anew whenever a property is set.
    const std::shared_ptr<const Law>& ownLaw() const { return ownLaw_; }

    // To be called when a joint of this kind is made: its stiffness is fixed then.
    void madeIn(const yade::Scene& scene) const { fixed_.fix(scene, {normalStiffness, shearStiffness}); }

protected:
    // Makes the law with the present properties. Throws std::invalid_argument for wrong properties, and for a stiffness
    // that is fixed and has changed.
    void makeLaw();

private:
    std::shared_ptr<const Law> ownLaw_;
    mutable Fixed fixed_;
};

} // namespace masonry
