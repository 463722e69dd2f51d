#pragma once
#include "Adapter.hpp"

namespace masonry {

class MasonryVtkRecorder : public Adapter<MasonryVtkRecorder, yade::GlobalEngine> {
public:
    static constexpr const char* className = "MasonryVtkRecorder";
    static constexpr const char* baseName = "GlobalEngine";
    static constexpr const char* doc =
        "Writes blocks.pvd and joints.pvd with their series for ParaView, a frame at every action: units in their "
        "reference place with displacement [m] and velocity [m/s], deformable ones as zones with stress (xx, yy, zz, "
        "xy, "
        "yz, xz) and principal stresses [Pa]; subcontacts as cells with opening and slip [m], "
        "normal and shear stress [Pa], the three damages [-], regime (0 elastic, 1 opening, 2 slipping, 3 crushing), "
        "kind and displacement [m]. Kinds are numbered in the order of `kinds`. Call it, or give it a period.";

    std::string directory = ".";
    int stepPeriod = 0;
    std::vector<double> times;
    std::vector<std::string> kinds;

    template <class Visit> static void attributes(Visit&& visit) {
        using R = MasonryVtkRecorder;
        visit("directory", &R::directory, "Existing folder to write to.", Given);
        visit("stepPeriod", &R::stepPeriod, "Steps between frames [-]; 0: only when called.");
        visit("kinds", &R::kinds, "Names of the joints' kinds, in the order of their numbers in the files.", ReadOnly);
        visit("times", &R::times, "Simulation times of the frames so far [s]; given, the series goes on after them.");
    }

    void postLoad();
    bool isActivated() override;
    void action() override;
    void collect() const;

    template <class PyClass> static void extras(PyClass& cls) {
        cls.def("collect", &MasonryVtkRecorder::collect,
                "Write blocks.pvd and joints.pvd alone, for the frames of `times`.");
    }

private:
    void writeBlocks(const std::string& path) const;
    void writeJoints(const std::string& path);
    void writeCollection(const std::string& name, const std::string& extension) const;
};

} // namespace masonry

BOOST_CLASS_EXPORT_KEY(masonry::MasonryVtkRecorder)
