// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryVtkRecorder.hpp"
#include "engine/bodies/Blocks.hpp"
#include "engine/connectors/Connectors.hpp"
#include "engine/store/SceneStore.hpp"
#include "engine/units/Zones.hpp"
#include "law/Laws.hpp"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <set>
#include <tuple>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataCompressor.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

// What is used of VTK's class: its own header needs those of TBB, which Debian's VTK does not bring.
namespace vtk::detail::smp {
class vtkSMPToolsAPI {
public:
    static vtkSMPToolsAPI& GetInstance();
    const char* GetBackend();
    bool SetBackend(const char* name);
};
} // namespace vtk::detail::smp

MASONRY_DEFINE(MasonryVtkRecorder)

namespace masonry {

namespace {

struct Field { // a column of numbers in the files; those that laws show come beside these
    const char* name;
    int components;
    Property about;
    bool whole = false; // whether its numbers are whole
};

const Field fields[] = {
    {"displacement", 3,
     number("m", "Displacement since the reference state, in which the points stand; of a point of a joint that of the "
                 "first of its `bodies`")},
    {"second_displacement", 3, number("m", "Displacement of a point of a joint with the second of its `bodies`")},
    {"rotation", 3,
     number("rad", "Rotation of a rigid unit since the reference state, a vector along its axis of the length of the "
                   "angle; its corners tell how far it moved. Zero in the zones of deformable units")},
    {"velocity", 3, number("m/s", "Velocity")},
    {"body", 1, described("Id of the unit's body"), true},
    {"stress", 6, number("Pa", "Stress of a zone of a deformable unit: xx, yy, zz, xy, yz, xz; zero in rigid units")},
    {"principal_stress", 3, number("Pa", "Principal stresses of a zone, the smallest first")},
    {"opening", 1, number("m", "Total opening of a subcontact; negative where it is closed")},
    {"slide", 3, number("m", "Slide of a subcontact since the reference state")},
    {"normal", 3, described("Unit normal of the joint in the reference state, from its first body to its second")},
    {"normal_stress", 1, number("Pa", "Normal stress, positive in tension")},
    {"shear_stress", 1, number("Pa", "Size of the shear stress")},
    {"shear_traction", 3,
     number("Pa",
            "Shear stress as a vector along the global axes: what the second of `bodies` does to the first, which "
            "has the same direction as `slide` where the joint is elastic; on the second it is the opposite. It "
            "lies in the joint's plane in the reference state, as `slide` and `normal` do")},
    {"area", 1, number("m²", "Area of a subcontact")},
    {"joint_dissipated", 3, number("J", "Energy that the whole joint dissipated in tension, shear and compression")},
    {"regime", 1, described("Regime in the last step: 0 elastic, 1 opening, 2 slipping, 3 crushing"), true},
    {"kind", 1, described("Number of the joint's kind in `kinds`"), true},
    {"bodies", 2, described("Ids of the two bodies of the joint, or of the tie or the spring; -1: the ground"), true},
    {"force", 3, number("N", "Force of a tie or a spring on the first of its `bodies`")},
    {"tension", 1, number("N", "Force of a tie along its line, positive in tension")},
    {"elongation", 1, number("m", "Elongation of the distance between the ends of a tie")},
    {"condition", 1, described("Of a tie: 0 elastic, 1 has yielded, 2 broken"), true},
};

vtkSmartPointer<vtkDataArray> newColumn(vtkDataSetAttributes* data, const Field& field) {
    vtkSmartPointer<vtkDataArray> array;
    if (field.whole)
        array = vtkSmartPointer<vtkIntArray>::New();
    else
        array = vtkSmartPointer<vtkDoubleArray>::New();
    array->SetName(field.name);
    array->SetNumberOfComponents(field.components);
    if (field.about.isNumber()) array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), field.about.unit);
    data->AddArray(array);
    return array;
}

// Some of the fields, to which rows are added.
class Rows {
public:
    Rows(vtkDataSetAttributes* data, std::initializer_list<const char*> names) {
        for (const char* name : names)
            columns_.push_back(newColumn(data, *std::find_if(std::begin(fields), std::end(fields), [&](const Field& f) {
                                             return std::strcmp(f.name, name) == 0;
                                         })));
    }
    // A row of values, in the order of the names.
    template <class... Values> void insert(const Values&... values) {
        auto column = columns_.begin();
        (put(**column++, values), ...);
    }

private:
    static void put(vtkDataArray& to, double value) { to.InsertNextTuple1(value); }
    static void put(vtkDataArray& to, const double* values) { to.InsertNextTuple(values); }
    static void put(vtkDataArray& to, const Vector3r& values) { to.InsertNextTuple(values.data()); }
    std::vector<vtkSmartPointer<vtkDataArray>> columns_;
};

// The columns of what the laws of a scene show. Every law has the first of them, the others are zero where the law of a
// joint does not show them.
class LawFields {
public:
    LawFields(vtkDataSetAttributes* data, const std::vector<JointKind>& kinds) {
        const auto add = [&](const JointField& field) {
            if (!columnOf(field)) columns_.push_back({field.name, newColumn(data, {field.name, 1, field.about})});
        };
        for (const auto* field : field::always)
            add(*field);
        for (const auto& kind : kinds)
            kind.states->columns->show(0, 0, [&](const JointField& field, double) { add(field); });
    }
    void insert(const JointPhysics& phys, int point) {
        for (auto& column : columns_)
            column.array->InsertNextTuple1(0);
        phys.group->columns->show(point, phys.index, [&](const JointField& field, double value) {
            auto& array = *columnOf(field)->array;
            array.SetComponent(array.GetNumberOfTuples() - 1, 0, value);
        });
    }

private:
    struct Column {
        const char* name;
        vtkSmartPointer<vtkDataArray> array;
    };
    Column* columnOf(const JointField& field) {
        for (auto& column : columns_)
            if (std::strcmp(column.name, field.name) == 0) return &column;
        return nullptr;
    }
    std::vector<Column> columns_;
};

// The numbers of an array for Python: a list of numbers, or of lists if it has several components.
py::list tuples(vtkDataArray& array) {
    py::list rows;
    const int width = array.GetNumberOfComponents();
    for (vtkIdType i = 0; i < array.GetNumberOfTuples(); ++i) {
        py::list row;
        for (int k = 0; k < width; ++k)
            row.append(array.GetComponent(i, k));
        if (width > 1)
            rows.append(row);
        else
            rows.append(row[0]);
    }
    return rows;
}

// Displacement of a place on a subcontact with the body of a side. With a deformable unit it is that of the
// subcontact's point, and what the unit's rotation adds beside this point.
Vector3r moved(const SceneStore& store, const JointGeometry& geom, int side, int point, const Vector3r& place) {
    const auto& r = geom.reference();
    const auto& from = r.sides[side];
    const auto& s = store.bodies.state(from.body);
    const Quaternionr turn = s.ori * from.orientation.conjugate();
    if (r.rigid(side)) return s.pos + turn * (place - from.position) - place;
    const Vector3r arm = place - geom.centre(point);
    return r.attached->zones->displacementAt(r.attached->sides[side][point]) + turn * arm - arm;
}

// Throws std::runtime_error for a file that cannot be written. Removes what was written of it, so that a full disk has
// room for the files that end a run.
[[noreturn]] void failed(const std::string& path, int reason) {
    std::remove(path.c_str());
    throw std::runtime_error("cannot write " + path + ": " + (reason ? std::strerror(reason) : "no reason known"));
}

// Seven digits are enough for pictures.
void roundArrays(vtkDataSetAttributes* data) {
    for (int n = 0; n < data->GetNumberOfArrays(); ++n) {
        auto* exact = vtkDoubleArray::SafeDownCast(data->GetArray(n));
        if (!exact) continue;
        vtkNew<vtkFloatArray> rounded;
        rounded->DeepCopy(exact);
        data->AddArray(rounded); // in the place of the one with this name
    }
}

template <class Writer, class Data> void write(const std::string& path, Data* data) {
    errno = 0;
    if (std::FILE* file = std::fopen(path.c_str(), "w")) // VTK's own message is long and without the reason
        std::fclose(file);
    else
        failed(path, errno);
    roundArrays(data->GetPointData());
    roundArrays(data->GetCellData());
    vtkNew<vtkFloatArray> rounded;
    rounded->DeepCopy(data->GetPoints()->GetData());
    data->GetPoints()->SetData(rounded);
    vtkNew<Writer> writer;
    writer->EncodeAppendedDataOff(); // base64 takes a third more
    writer->SetFileName(path.c_str());
    writer->SetInputData(data);
    writer->GetCompressor()->SetCompressionLevel(1); // VTK's default takes twice the time for a tenth less space
    const int shown = vtkObject::GetGlobalWarningDisplay();
    vtkObject::GlobalWarningDisplayOff();
    // The process that writes may be a copy of another, which has none of VTK's threads and would wait for them.
    auto& threads = vtk::detail::smp::vtkSMPToolsAPI::GetInstance();
    const std::string before = threads.GetBackend();
    threads.SetBackend("Sequential");
    const bool written = writer->Write() && !writer->GetErrorCode();
    threads.SetBackend(before.c_str());
    vtkObject::SetGlobalWarningDisplay(shown);
    if (!written) failed(path, errno);
}

std::string frame(const std::string& name, std::size_t number, const std::string& extension) {
    const auto digits = std::to_string(number);
    return name + "_" + std::string(4 - std::min<std::size_t>(4, digits.size()), '0') + digits + extension;
}

// The three tetrahedra of a prism over a triangle, whose upper corners have numbers larger by `up`, in an order that
// makes their volumes positive. The diagonals of its sides start at the corner with the smaller number, so that
// neighbours have the same ones.
std::vector<std::array<int, 4>> prism(const std::array<int, 3>& t, int up) {
    auto [a, b, c] = t;
    for (int i = 0; i < 2; ++i) // begin with the smallest number, and keep the order around
        if (a > b || a > c) std::tie(a, b, c) = std::make_tuple(b, c, a);
    if (b < c) return {{a, b, c, c + up}, {a, b, c + up, b + up}, {a, b + up, c + up, a + up}};
    return {{a, b, c, b + up}, {a, b + up, c, c + up}, {a, b + up, c + up, a + up}};
}

} // namespace

std::vector<std::string> MasonryVtkRecorder::problems() const {
    std::vector<std::string> wrong;
    if (directory.empty()) wrong.push_back("directory must not be empty");
    if (!std::all_of(times.begin(), times.end(), [](double time) { return std::isfinite(time); }))
        wrong.push_back("times must be finite numbers [s]");
    return wrong;
}

py::dict MasonryVtkRecorder::fieldsOfFiles() {
    py::dict all;
    for (const auto& field : fields)
        all[field.name] = field.about.documentation();
    for (const auto* field : field::always)
        all[field->name] = field->about.documentation();
    for (const auto& law : laws())
        law.show([&](const JointField& field, double) { all[field.name] = field.about.documentation(); });
    return all;
}

bool MasonryVtkRecorder::isActivated() { return stepPeriod > 0 && scene->iter % stepPeriod == 0; }

void MasonryVtkRecorder::action() {
    const BetweenSteps still;
    std::vector<std::string> written;
    const auto path = [&](const char* name, const char* extension) {
        written.push_back(directory + "/" + frame(name, times.size(), extension));
        return written.back();
    };
    try {
        writeBlocks(path("blocks", ".vtu"));
        writeJoints(path("joints", ".vtp"));
        if (hasConnectors()) writeConnectors(path("connectors", ".vtp"));
    } catch (...) {
        for (const auto& one : written) // a frame is written whole or not at all
            std::remove(one.c_str());
        throw;
    }
    times.push_back(scene->time);
    collect();
}

bool MasonryVtkRecorder::hasConnectors() const {
    auto& store = SceneStore::of(*scene);
    store.update();
    return !store.connectors.empty();
}

void MasonryVtkRecorder::collect() const {
    writeCollection("blocks", ".vtu");
    writeCollection("joints", ".vtp");
    if (hasConnectors()) writeCollection("connectors", ".vtp");
}

void MasonryVtkRecorder::writeBlocks(const std::string& path) const {
    vtkNew<vtkUnstructuredGrid> grid;
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    Rows ofPoints(grid->GetPointData(), {"displacement", "velocity"});
    Rows ofCells(grid->GetCellData(), {"body", "rotation", "stress", "principal_stress"});
    const double none[6] = {};
    std::set<int> deformable;
    for (const auto& engine : scene->engines) {
        auto* zones = dynamic_cast<Zones*>(engine.get());
        for (const auto& unit : zones ? zones->units() : std::vector<Zones::Unit>{}) {
            deformable.insert(unit.body);
            const auto& mesh = unit.elasticity->mesh();
            const auto first = points->GetNumberOfPoints();
            const int nodes = int(mesh.nodes.size()), across = mesh.across;
            std::vector<Vector3r> u;
            for (int n = 0; n < nodes; ++n)
                u.push_back(zones->displacementOf(unit.firstNode + n));
            // A plane unit is drawn as thick as it is: every node stands for a point on either of its faces.
            for (int face = 0; face < (across < 0 ? 1 : 2); ++face)
                for (int n = 0; n < nodes; ++n) {
                    Vector3r place = unit.centre + mesh.nodes[n];
                    if (across >= 0) place[across] += (face - 0.5) * mesh.thickness;
                    points->InsertNextPoint(place.data());
                    ofPoints.insert(u[n], zones->velocityOf(unit.firstNode + n));
                }
            const Matrix3 rotation = unit.elasticity->rotation(u.data());
            const int all = int(across < 0 ? mesh.zones.size() : mesh.triangles.size());
            for (int z = 0; z < all; ++z) {
                const Matrix3 s = unit.elasticity->stress(z, u.data(), rotation);
                const double six[6] = {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
                const Vector3r three = Eigen::SelfAdjointEigenSolver<Matrix3>(s).eigenvalues();
                for (const auto& zone :
                     across < 0 ? std::vector<std::array<int, 4>>{mesh.zones[z]} : prism(mesh.triangles[z], nodes)) {
                    vtkIdType corners[4];
                    for (int i = 0; i < 4; ++i)
                        corners[i] = first + zone[i];
                    grid->InsertNextCell(VTK_TETRA, 4, corners);
                    ofCells.insert(unit.body, none, six, three);
                }
            }
        }
    }
    for (const auto& body : scene->bodies->body) {
        if (body && deformable.count(body->id)) continue;
        if (!body || !isBlock(body->shape.get())) continue;
        const auto& s = *body->state;
        const auto first = points->GetNumberOfPoints();
        const auto block = blockOf(*body->shape);
        for (const auto& v : block.vertices) {
            const Vector3r reference = s.refPos + s.refOri * v, arm = s.ori * v;
            points->InsertNextPoint(reference.data());
            ofPoints.insert(Vector3r(s.pos + arm - reference), Vector3r(s.vel + s.angVel.cross(arm)));
        }
        vtkNew<vtkIdList> faces; // number of faces, then for each face its number of corners and the corners
        faces->InsertNextId(block.triangles.size());
        for (const auto& t : block.triangles) {
            faces->InsertNextId(3);
            for (int corner : t)
                faces->InsertNextId(first + corner);
        }
        grid->InsertNextCell(VTK_POLYHEDRON, faces);
        const Eigen::AngleAxisd turn(s.ori * s.refOri.conjugate());
        ofCells.insert(body->id, Vector3r(turn.angle() * turn.axis()), none, none);
    }
    grid->SetPoints(points);
    write<vtkXMLUnstructuredGridWriter>(path, grid.Get());
}

vtkSmartPointer<vtkPolyData> MasonryVtkRecorder::jointData() {
    vtkNew<vtkPolyData> data;
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    vtkNew<vtkCellArray> cells;
    Rows ofPoints(data->GetPointData(), {"displacement", "second_displacement"});
    auto* values = data->GetCellData();
    Rows ofCells(values, {"opening", "slide", "normal", "normal_stress", "shear_stress", "shear_traction", "area",
                          "joint_dissipated", "regime", "kind", "bodies"});

    auto& store = SceneStore::of(*scene);
    store.update();
    LawFields ofLaws(values, store.kinds);
    for (const auto& joint : store.joints) {
        const auto& geom = *joint.geom;
        const auto& phys = *joint.phys;
        const auto& r = geom.reference();
        const auto& name = phys.propertySet()->name;
        const auto known = std::find(kinds.begin(), kinds.end(), name);
        const int number = int(known - kinds.begin());
        if (known == kinds.end()) kinds.push_back(name);
        const Vector3r side = r.normal.cross(r.tangent);
        const auto parts = geom.cells();
        Vector3r dissipated = Vector3r::Zero();
        for (int p = 0; p < geom.points(); ++p) {
            const auto e = phys.lost(p);
            dissipated += geom.area(p) * Vector3r(e.tension, e.shear, e.compression);
        }
        for (int p = 0; p < geom.points(); ++p) {
            cells->InsertNextCell(int(parts[p].size()));
            for (const auto& corner : parts[p]) {
                cells->InsertCellPoint(points->InsertNextPoint(corner.data()));
                ofPoints.insert(moved(store, geom, 0, p, corner), moved(store, geom, 1, p, corner));
            }
            const auto s = phys.state(p);
            const Vector3r jump = geom.jump(p);
            const Vector3r slide = jump[1] * r.tangent + jump[2] * side;
            const Vector3r traction = s.shearStress.a * r.tangent + s.shearStress.b * side;
            const double bodies[2] = {double(joint.interaction->id1), double(joint.interaction->id2)};
            ofCells.insert(s.opening, slide, r.normal, s.normalStress, std::hypot(s.shearStress.a, s.shearStress.b),
                           traction, geom.area(p), dissipated, double(s.regime), number, bodies);
            ofLaws.insert(phys, p);
        }
    }
    data->SetPoints(points);
    data->SetPolys(cells);
    return data;
}

void MasonryVtkRecorder::writeJoints(const std::string& path) { write<vtkXMLPolyDataWriter>(path, jointData().Get()); }

void MasonryVtkRecorder::writeConnectors(const std::string& path) const {
    vtkNew<vtkPolyData> data;
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    vtkNew<vtkCellArray> ofBars, ofSprings;
    Rows ofPoints(data->GetPointData(), {"displacement"});
    Rows ofCells(data->GetCellData(), {"force", "tension", "elongation", "condition", "bodies"});
    const auto& store = SceneStore::of(*scene);
    for (const bool bars : {false, true}) // VTK numbers cells that are points before those that are lines
        for (const Connectors* all : store.connectors) {
            if (all->isBar() != bars) continue;
            for (int i = 0; i < all->count(); ++i) {
                const auto at = std::size_t(i);
                const auto add = [&](int body, const Vector3r& point) {
                    ofPoints.insert(Vector3r(Connectors::endOf(store, body, point).place - point));
                    return points->InsertNextPoint(point.data());
                };
                vtkIdType ends[2] = {add(all->bodies1[at], all->points1[at])};
                if (bars) {
                    ends[1] = add(all->bodies2[at], all->points2[at]);
                    ofBars->InsertNextCell(2, ends);
                } else
                    ofSprings->InsertNextCell(1, ends);
                const auto view = all->view(store, i);
                const double bodies[2] = {double(all->bodies1[at]), double(all->bodies2[at])};
                ofCells.insert(view.force, view.tension, view.elongation, view.condition, bodies);
            }
        }
    data->SetPoints(points);
    data->SetVerts(ofSprings);
    data->SetLines(ofBars);
    write<vtkXMLPolyDataWriter>(path, data.Get());
}

py::dict MasonryVtkRecorder::jointsNow() {
    const BetweenSteps still;
    const auto data = jointData();
    py::dict found;
    found["points"] = tuples(*data->GetPoints()->GetData());
    for (vtkDataSetAttributes* values : {static_cast<vtkDataSetAttributes*>(data->GetPointData()),
                                         static_cast<vtkDataSetAttributes*>(data->GetCellData())})
        for (int i = 0; i < values->GetNumberOfArrays(); ++i)
            found[values->GetArrayName(i)] = tuples(*values->GetArray(i));
    py::list cells;
    vtkNew<vtkIdList> corners;
    auto* polygons = data->GetPolys();
    polygons->InitTraversal();
    while (polygons->GetNextCell(corners)) {
        py::list cell;
        for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i)
            cell.append(corners->GetId(i));
        cells.append(cell);
    }
    found["cells"] = cells;
    return found;
}

void MasonryVtkRecorder::writeCollection(const std::string& name, const std::string& extension) const {
    const auto path = directory + "/" + name + ".pvd";
    const auto fresh = path + ".new"; // renamed at the end, so that the old file stays if the disk is full
    std::ofstream out(fresh);
    out.precision(12);
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
    for (std::size_t i = 0; i < times.size(); ++i) {
        const auto file = frame(name, i, extension);
        if (!std::ifstream(directory + "/" + file)) continue; // somebody has removed it
        out << "<DataSet timestep=\"" << times[i] << "\" file=\"" << file << "\"/>\n";
    }
    out << "</Collection>\n</VTKFile>\n";
    if (!out.flush()) failed(fresh, errno);
    if (std::rename(fresh.c_str(), path.c_str())) failed(fresh, errno);
}

} // namespace masonry
