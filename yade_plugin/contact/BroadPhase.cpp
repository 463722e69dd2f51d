// SPDX-License-Identifier: GPL-2.0-or-later
#include "BroadPhase.hpp"
#include <algorithm>
#include <numeric>

namespace masonry {

namespace {

// The axis along which the middles of the boxes that are awake scatter most, so that few overlap along it.
int widestAxis(const std::vector<Box>& boxes, const std::vector<unsigned char>& awake) {
    int widest = 0;
    double most = -1;
    for (int d = 0; d < 3; ++d) {
        double sum = 0, square = 0, count = 0;
        for (std::size_t b = 0; b < boxes.size(); ++b) {
            if (!awake[b]) continue;
            const double middle = 0.5 * (boxes[b].low[d] + boxes[b].high[d]);
            sum += middle;
            square += middle * middle;
            ++count;
        }
        const double scatter = count > 0 ? square - sum * sum / count : 0;
        if (scatter > most) {
            most = scatter;
            widest = d;
        }
    }
    return widest;
}

} // namespace

std::vector<std::pair<int, int>> overlappingBoxes(const std::vector<Box>& boxes,
                                                  const std::vector<unsigned char>& awake) {
    const int axis = widestAxis(boxes, awake), second = (axis + 1) % 3, third = (axis + 2) % 3;
    std::vector<int> order(boxes.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        const double x = boxes[a].low[axis], y = boxes[b].low[axis];
        return x != y ? x < y : a < b;
    });
    std::vector<std::pair<int, int>> found;
    std::vector<int> open, openAwake; // boxes that the sweep has entered: all, and those that are awake
    for (int b : order) {
        const Box& box = boxes[b];
        const auto meet = [&](std::vector<int>& others) {
            std::size_t kept = 0;
            for (int other : others) {
                const Box& o = boxes[other];
                if (o.high[axis] < box.low[axis]) continue; // the sweep has passed it
                others[kept++] = other;
                if (o.low[second] <= box.high[second] && box.low[second] <= o.high[second] &&
                    o.low[third] <= box.high[third] && box.low[third] <= o.high[third])
                    found.emplace_back(std::min(b, other), std::max(b, other));
            }
            others.resize(kept);
        };
        // What sleeps meets only what is awake.
        meet(openAwake);
        if (awake[b]) {
            meet(open);
            openAwake.push_back(b);
        } else
            open.push_back(b);
    }
    std::sort(found.begin(), found.end());
    return found;
}

} // namespace masonry
