// SPDX-License-Identifier: GPL-2.0-or-later
// The overlap of two convex blocks: the force between them, its potential, and the area on which they press. The
// equations are derived in contact/README.md.
#pragma once
#include "ContactBlock.hpp"
#include "common/PlainVector.hpp"

namespace masonry {

// Place and orientation of the other block in the axes of the one block.
struct RelativePose {
    Eigen::Matrix3d turn;  // from the axes of the other block to those of the one
    Eigen::Vector3d place; // origin of the other block [m]
};

// What two blocks do to each other, for a stiffness of 1 Pa/m, in the axes of the one block; moments are about its
// origin.
struct Overlap {
    Eigen::Vector3d force;  // on the other block [m³]; the one block has the opposite
    Eigen::Vector3d moment; // on the other block about the origin of the one [m⁴]; the one block has the opposite
    double touched;         // half of the area of both surfaces inside the other block [m²]
    // Where the two press: the force without direction. Zero where nothing presses.
    double pressing;        // integral of the pressure over both surfaces [m³]
    Eigen::Vector3d centre; // centre of pressure [m]
    double meanSquare;      // mean square of the distance from the centre, weighted with the pressure [m²]
    // The contact area: both surfaces inside the other block, as far as they look against the force, projected along
    // it, and their mean. Zero where the force is.
    Eigen::Vector3d normal;       // direction of `force`
    double area;                  // [m²]
    Eigen::Vector3d firstMoment;  // of that area [m³]
    Eigen::Matrix3d secondMoment; // of that area [m⁴]
};

// Finds overlaps. It owns the buffers, so that finding one allocates nothing.
class OverlapFinder {
public:
    // To be called once for every block before it is used.
    void provideFor(const ContactBlock&);

    // The overlap of two blocks; false if they do not press on each other. `axis` is a number that the caller keeps for
    // each pair, at first 0: the face, or the two edges, whose plane separated the two when they were last looked at.
    bool find(const ContactBlock& one, const ContactBlock& other, const RelativePose&, int& axis, Overlap&);

    // The potential, for a stiffness of 1 Pa/m [m⁴].
    double potential(const ContactBlock& one, const ContactBlock& other, const RelativePose&);

private:
    using Corner = PlainVector;
    struct Plane {
        PlainVector normal;
        double offset;
        double depth(const Corner& p) const { return offset - dot(normal, p); } // of a point below a face
        Plane operator-(const Plane& o) const { return {normal - o.normal, offset - o.offset}; }
    };
    struct Side { // a block in the axes of the one block
        const ContactBlock* block;
        std::vector<Corner> corners;
        std::vector<Plane> planes;
        std::vector<double> depths; // of its corners below all faces of the opposite block, face by face
        int shallow;                // the face of the opposite block below which its deepest corner is least deep
        double least;               // that depth [m]
    };
    struct Sums {                       // of a part of a face
        double pressure = 0;            // integral of the depth [m³]
        double square = 0;              // integral of the depth times the square of the distance from the origin
        PlainVector first{};            // of the depth [m⁴]
        double area = 0;                // [m²]
        PlainVector firstOfArea{};      // [m³]
        PlainVector squares{}, mixed{}; // of the area: x², y², z², and xy, yz, zx [m⁴]
    };
    struct Patch { // a face of a block inside the other block
        PlainVector normal;
        double sign; // 1 for the one block, -1 for the other
        Sums sums;
    };

    void place(const ContactBlock& one, const ContactBlock& other, const RelativePose&);
    bool separates(const Side& of, Side& from, int face);
    bool edgesSeparate(const RelativePose&, int edges) const;
    // Cuts the present polygon; false if nothing remains. `kept` is what becomes of a polygon that lies in the plane.
    bool cut(const Plane&, bool kept);
    // Makes what of a face lies inside the opposite block the present polygon, and finds which of the opposite faces
    // may be the nearest somewhere on it: `nearest_`, that in whose depth its deepest point is least deep first.
    // Returns their number, 0 if nothing lies inside.
    int clip(const Side& of, const Side& inside, int face);
    // Makes the part of `whole_` where this one of them is the nearest the present polygon; false if there is none.
    bool cell(const Side& inside, int number, int count);
    void addPatches(const Side& of, const Side& inside, double sign);
    // Adds integrals of a pressure over the present polygon, and those of the area if they are wanted.
    void addParts(const Plane& pressure, const Plane& face, bool area, Sums&) const;
    double squareOf(const Plane& depth, const Eigen::Vector3d& normal) const;
    Corner& corner(int number) { return polygon_[number]; }
    double depthIntegral(const Side& of, const Side& inside);

    Side one_, other_;
    std::vector<Corner> polygon_, spare_, whole_;
    std::vector<double> signs_, least_;
    int wholeSize_ = 0; // corners of `whole_`
    std::vector<int> nearest_;
    std::vector<unsigned char> cells_; // whether a face of the opposite block is the nearest somewhere in the overlap
    std::vector<Patch> patches_;
    int size_ = 0;         // corners of the present polygon
    double tolerance_ = 0; // depths below this are zero [m]
};

} // namespace masonry
