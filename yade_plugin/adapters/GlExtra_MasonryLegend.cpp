// SPDX-License-Identifier: GPL-2.0-or-later
#include "GlExtra_MasonryLegend.hpp"
#include "Colours.hpp"
#include "common/Text.hpp"
#include <GL/gl.h>
#include <utility>

MASONRY_DEFINE(GlExtra_MasonryLegend)

// Of FreeGLUT, which YADE has loaded and started: a letter at the place that glRasterPos has set.
extern "C" {
void glutBitmapCharacter(void* font, int letter);
extern void* glutBitmapHelvetica12;
}

namespace masonry {

namespace {

constexpr double barWidth = 160, barHeight = 12, line = 16, margin = 14; // [pixels]

void write(double x, double y, const std::string& words) {
    glColor3f(0, 0, 0);
    glRasterPos2d(x, y);
    for (char letter : words)
        glutBitmapCharacter(&glutBitmapHelvetica12, letter);
}

void box(double x, double y, double width, double height, const Colour& left, const Colour& right) {
    glBegin(GL_QUADS);
    glColor3fv(left.data());
    glVertex2d(x, y);
    glVertex2d(x, y + height);
    glColor3fv(right.data());
    glVertex2d(x + width, y + height);
    glVertex2d(x + width, y);
    glEnd();
}

// Returns the height at which the next scale may stand.
double drawScale(const ColourScale& scale, double x, double y) {
    if (scale.names.empty()) {
        const auto parts = scale.colours.size() - 1;
        for (std::size_t i = 0; i < parts; ++i)
            box(x + barWidth * double(i) / double(parts), y, barWidth / double(parts), barHeight, scale.colours[i],
                scale.colours[i + 1]);
        write(x + barWidth + 6, y + 2, text(scale.most));
        y += line;
        write(x, y + 2, scale.title + ", from 0");
        return y + 1.5 * line;
    }
    for (std::size_t i = scale.names.size(); i-- > 0;) {
        const auto colour = scale.of(int(i));
        box(x, y, 2 * barHeight, barHeight, colour, colour);
        write(x + 2 * barHeight + 6, y + 2, scale.names[i].empty() ? "without a name" : scale.names[i]);
        y += line;
    }
    write(x, y + 2, scale.title);
    return y + 1.5 * line;
}

double heightOf(const ColourScale& scale) {
    if (!scale.shown()) return 0;
    return scale.names.empty() ? 2.5 * line : (1.5 + double(scale.names.size())) * line;
}

} // namespace

void GlExtra_MasonryLegend::render() {
    // What the next picture draws says anew what it is, so that nothing is reported of what is no longer shown.
    const auto scales = std::exchange(drawnScales(), {});
    const double height = heightOf(scales.blocks) + heightOf(scales.joints);
    if (dead || height == 0) return;
    int view[4];
    glGetIntegerv(GL_VIEWPORT, view);
    glPushAttrib(GL_ALL_ATTRIB_BITS);
    glDisable(GL_LIGHTING);
    glDisable(GL_DEPTH_TEST);
    glMatrixMode(GL_PROJECTION);
    glPushMatrix();
    glLoadIdentity();
    glOrtho(0, view[2], 0, view[3], -1, 1);
    glMatrixMode(GL_MODELVIEW);
    glPushMatrix();
    glLoadIdentity();
    const Colour white = {1, 1, 1};
    const double width = barWidth + 90, left = view[2] - width - margin; // YADE writes at the left
    box(left, margin, width, height + 4, white, white);
    double y = margin + 8;
    for (const auto* scale : {&scales.joints, &scales.blocks})
        if (scale->shown()) y = drawScale(*scale, left + 6, y);
    glPopMatrix();
    glMatrixMode(GL_PROJECTION);
    glPopMatrix();
    glMatrixMode(GL_MODELVIEW);
    glPopAttrib();
}

} // namespace masonry
