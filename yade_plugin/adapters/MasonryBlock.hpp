// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include "blocks/BlockShape.hpp"
#include "engine/bodies/Blocks.hpp"

namespace masonry {

class MasonryBlock : public Adapter<MasonryBlock, yade::Shape>, public BlockSurface {
    MASONRY_DISPATCHED(MasonryBlock, Shape)
    static constexpr const char* doc =
        "A convex block, about its centroid and in its principal axes. masonry.addBlock() makes bodies of this shape. "
        "MasonryBlock.around(points) gives the shape alone, with the place and orientation of its body; an object "
        "without corners is no block, and a scene that holds one is refused.";

    double volume = 0;
    Vector3r inertia = Vector3r::Zero();

    template <class Visit> static void attributes(Visit&& visit) {
        using B = MasonryBlock;
        visit("v", &B::v, described("Corners [m], relative to the centroid, in the axes of the body"), ReadOnly);
        visit("triangles", &B::triangles,
              described("Triangles of the surface: three numbers of corners each, counter-clockwise seen from outside"),
              ReadOnly);
        visit("volume", &B::volume, number("m³", "Volume"), ReadOnly);
        visit("inertia", &B::inertia,
              number("m⁵", "Principal moments of inertia about the centroid, for a density of 1 kg/m³"), ReadOnly);
    }

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("around", &MasonryBlock::around, py::arg("points"),
                "The convex block around points [m]: (MasonryBlock, centroid [m], orientation), the last two in the "
                "axes of the points. Points that are no corners of it are left out.")
            .staticmethod("around");
    }

    MasonryBlock() {
        createIndex();
        color = Vector3r::Ones(); // as YADE's own constructor of Shape sets it
        wire = highlight = false;
    }

    // [m³]; overrides a function of YADE's Shape where that has one.
    double getVolume() { return volume; }

    // Throws std::runtime_error if a saved file holds corners or triangles that make no block.
    void postLoad();

private:
    static py::tuple around(const std::vector<Vector3r>& points);
};

} // namespace masonry

MASONRY_DECLARE(MasonryBlock)
