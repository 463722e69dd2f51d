// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "host/YadeGl.hpp"

namespace masonry {

class GlExtra_MasonryLegend : public Adapter<GlExtra_MasonryLegend, yade::GlExtraDrawer> {
    MASONRY_CLASS(GlExtra_MasonryLegend, GlExtraDrawer)
    static constexpr const char* doc =
        "Says in YADE's 3-D view what the colours of blocks and joints mean. It works in "
        "Renderer().extraDrawers; masonry.model.window.show() puts it there.";

    template <class Visit> static void attributes(Visit&&) {}

    void render() override;
};

} // namespace masonry

MASONRY_DECLARE(GlExtra_MasonryLegend)
