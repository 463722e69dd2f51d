// The state of a scene as a checkpoint's bytes, and back into the same scene built anew.
#pragma once
#include "host/Yade.hpp"

namespace masonry {

// The present scene's: time, motions and forces of all bodies, joints, and engines of this plugin; with a text of the
// user's. Throws std::invalid_argument for a state that has left finite numbers.
boost::python::object saveScene(const std::string& extra);

// Gives the present scene the state that was saved, and the user's text back. Throws std::invalid_argument, and leaves
// the scene as it is, for bytes that are damaged or of another scene.
std::string loadScene(const boost::python::object& bytes);

// The user's text alone.
std::string savedText(const boost::python::object& bytes);

} // namespace masonry
