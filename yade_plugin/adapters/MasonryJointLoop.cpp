#include "MasonryJointLoop.hpp"
#include "SceneStore.hpp"

template class masonry::Adapter<masonry::MasonryJointLoop, yade::GlobalEngine>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryJointLoop)

namespace masonry {

void MasonryJointLoop::action() {
    const EngineTurn turn(*scene, *this);
    plan_.advance(turn.store());
}

} // namespace masonry
