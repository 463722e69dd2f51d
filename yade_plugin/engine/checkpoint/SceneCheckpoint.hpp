// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the state of a scene into the bytes of a checkpoint, and brings it back into the same scene that was built
// again.
#pragma once
#include "host/Yade.hpp"

namespace masonry {

// The state of the present scene: time, motions and forces of all bodies, joints, and engines of this plugin; and a
// text of the caller. Throws std::invalid_argument if a number of the state is not finite.
boost::python::object saveScene(const std::string& extra);

// Sets the present scene to the state that was saved, and returns the caller's text. If the bytes are damaged or belong
// to another scene, throws std::invalid_argument and leaves the scene as it is.
std::string loadScene(const boost::python::object& bytes);

// The caller's text alone. The scene is not changed.
std::string savedText(const boost::python::object& bytes);

} // namespace masonry
