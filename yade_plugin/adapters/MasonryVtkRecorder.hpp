// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Adapter.hpp"
#include <vtkSmartPointer.h>

class vtkPolyData;

namespace masonry {

class MasonryVtkRecorder : public Adapter<MasonryVtkRecorder, yade::GlobalEngine> {
    MASONRY_CLASS(MasonryVtkRecorder, GlobalEngine)
    static constexpr ClassRole declares = ClassRole::Recorder;
    static constexpr const char* doc =
        "Writes blocks.pvd and joints.pvd with their series of files for ParaView, one frame at every action, and "
        "connectors.pvd where there are ties or springs. Units "
        "stand at their reference place, deformable ones are drawn as zones, subcontacts are cells, ties are lines and "
        "springs points. fields() says "
        "what the files hold, and every field carries its unit. Call the engine as a function for a frame, or set "
        "stepPeriod.";

    std::string directory = ".";
    int stepPeriod = 0;
    std::vector<double> times;
    std::vector<std::string> kinds;

    template <class Visit> static void attributes(Visit&& visit) {
        using R = MasonryVtkRecorder;
        visit("directory", &R::directory, described("Existing folder to write to"), Given);
        visit("stepPeriod", &R::stepPeriod, number("-", "Steps between frames; 0: only when called").atLeast(0));
        visit("kinds", &R::kinds, described("Names of the joints' kinds, in the order of their numbers in the files"),
              ReadOnly);
        visit("times", &R::times,
              number("s",
                     "Simulation times of the frames so far; a new recorder that is given them continues the series"));
    }

    std::vector<std::string> problems() const;
    bool isActivated() override;
    void action() override;
    void collect() const;

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("collect", &MasonryVtkRecorder::collect,
                "Write blocks.pvd, joints.pvd and connectors.pvd alone, for the frames of `times`.")
            .def("joints", &MasonryVtkRecorder::jointsNow,
                 "All joints as they are now, without a file: a dict of what a file of joints holds, by the names of "
                 "fields(), with `points` [m] and `cells`, lists of numbers of points.")
            .def("fields", &MasonryVtkRecorder::fieldsOfFiles,
                 "What the files hold: a dict of name -> meaning with unit.")
            .staticmethod("fields");
    }

private:
    static py::dict fieldsOfFiles();
    void writeBlocks(const std::string& path) const;
    vtkSmartPointer<vtkPolyData> jointData();
    void writeJoints(const std::string& path);
    bool hasConnectors() const;
    void writeConnectors(const std::string& path) const;
    py::dict jointsNow();
    void writeCollection(const std::string& name, const std::string& extension) const;
};

} // namespace masonry

MASONRY_DECLARE(MasonryVtkRecorder)
