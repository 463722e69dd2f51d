// SPDX-License-Identifier: GPL-2.0-or-later
// Moves the state of a scene into a checkpoint or back: one code names every value, and the direction decides which
// side is written.
#pragma once
#include "common/StateNumbers.hpp"
#include "files/Checkpoint.hpp"
#include "host/Yade.hpp"

namespace masonry {

using yade::Quaternionr;
using yade::Vector3r;

class Transfer {
public:
    const bool back;   // whether the state goes from the checkpoint to the scene
    std::string owner; // stands before every name in the checkpoint, and says whose state it is

    Transfer(Checkpoint& file, bool back) : back(back), file_(file) {}

    void operator()(const std::string& name, std::string& value) {
        auto& text = file_.texts[owner + name];
        (back ? value : text) = back ? text : value;
    }
    // `visit` is called with the StateNumbers of this name. A checkpoint with other numbers than it asks for is
    // refused.
    template <class F> void numbers(const std::string& name, F&& visit) {
        auto& flat = file_.numbers[owner + name];
        if (!back) {
            StateNumbers to(flat);
            return visit(to);
        }
        StateNumbers from(flat, misfit(name));
        visit(from);
        from.end();
    }
    template <class T> void operator()(const std::string& name, T& value) {
        numbers(name, [&](StateNumbers& n) { n(value); });
    }

private:
    std::string misfit(const std::string& name) const { return "does not fit this scene, at '" + owner + name + "'"; }

    Checkpoint& file_;
};

// Base of all objects that have a state of their own in checkpoints.
struct Stateful {
    virtual ~Stateful() = default;
    virtual void transfer(Transfer&) = 0;
};

} // namespace masonry
