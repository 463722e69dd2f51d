// SPDX-License-Identifier: GPL-2.0-or-later
// Values that cannot change any more because joints were made with them, and an error that says so.
#pragma once
#include "common/Text.hpp"
#include "host/Yade.hpp"
#include <boost/weak_ptr.hpp>

namespace masonry {

class Fixed {
public:
    // To be called with the values that a joint of this scene was made, or a deformable unit divided with.
    void fix(const yade::Scene& scene, const std::vector<double>& values) {
        scene_ = boost::const_pointer_cast<yade::Factorable>(scene.shared_from_this());
        values_ = values;
    }
    // One sentence for each value that is another one now, while that scene has joints.
    std::vector<std::string> problems(const std::vector<const char*>& names, const std::vector<double>& now) const {
        std::vector<std::string> wrong;
        const auto scene = boost::dynamic_pointer_cast<yade::Scene>(scene_.lock());
        if (!scene || scene->interactions->currSize == 0) return wrong;
        for (std::size_t i = 0; i < now.size(); ++i)
            if (now[i] != values_[i])
                wrong.push_back(std::string(names[i]) + " " + text(now[i]) +
                                " would have no effect, the joints of this "
                                "scene were made with " +
                                text(values_[i]) +
                                ": set it before connect(), or build the "
                                "scene anew");
        return wrong;
    }

private:
    boost::weak_ptr<yade::Factorable> scene_;
    std::vector<double> values_;
};

} // namespace masonry
