// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "host/YadeGl.hpp"

namespace masonry {

class GlExtra_MasonryLegend : public Adapter<GlExtra_MasonryLegend, yade::GlExtraDrawer> {
public:
    static constexpr const char* className = "GlExtra_MasonryLegend";
    static constexpr const char* baseName = "GlExtraDrawer";
    static constexpr const char* doc =
        "Says in YADE's 3-D view what the colours of blocks and joints mean. It works in "
        "Renderer().extraDrawers; masonry.model.window.show() puts it there.";

    template <class Visit> static void attributes(Visit&&) {}

    void render() override;
};

} // namespace masonry

extern template class masonry::Adapter<masonry::GlExtra_MasonryLegend, yade::GlExtraDrawer>;
BOOST_CLASS_EXPORT_KEY(masonry::GlExtra_MasonryLegend)
