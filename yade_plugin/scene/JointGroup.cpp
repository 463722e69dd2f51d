// SPDX-License-Identifier: GPL-2.0-or-later
#include "JointGroup.hpp"
#include "common/Vectorised.hpp"

namespace masonry {

JointShapes::JointShapes(int count, int pointCount)
    : points(pointCount), stride(count == 1 ? 1 : (count + lanes - 1) / lanes * lanes), joints(count) {
    for (auto* column : {&jump[0], &jump[1], &jump[2], &area, &offset[0], &offset[1], &offset[2]})
        column->assign(std::size_t(stride) * points, 0);
}

void JointShapes::take(int joint, const JointShapes& from, int other) {
    joints[joint] = from.joints[other];
    for (int p = 0; p < points; ++p) {
        setJump(p, joint, from.jumpAt(p, other));
        setViscous(p, joint, from.viscousAt(p, other));
        setShape(p, joint, from.offsetAt(p, other), from.areaAt(p, other));
    }
}

void JointShapes::shareShapes() {
    constexpr int most = JointFrames::most;
    const int count = int(joints.size());
    if (alike || count < most) return;
    const double length = joints[0].span().norm();
    for (int p = 0; p < points; ++p)
        for (int j = 1; j < count; ++j) {
            if (!sameButRoundOff(areaAt(p, j), areaAt(p, 0), areaAt(p, 0))) return;
            for (int d = 0; d < 3; ++d)
                if (!sameButRoundOff(offsetAt(p, j)[d], offsetAt(p, 0)[d], length)) return;
        }
    for (auto* column : {&area, &offset[0], &offset[1], &offset[2]}) {
        std::vector<double> shared(std::size_t(most) * points);
        for (int p = 0; p < points; ++p)
            std::fill_n(shared.begin() + p * most, most, (*column)[std::size_t(p) * stride]);
        column->swap(shared);
    }
    alike = true;
}

} // namespace masonry
