// The law against closed form (law.md §6) and its consequences (law.md §5), at the bed joint of the CS walls.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "law/JointColumns.hpp"
#include <doctest/doctest.h>
#include <functional>
#include <random>
#include <stdexcept>

using namespace masonry;

namespace {

const JointProperties bed;

ElasticStiffness own(const JointProperties& p) { return {p.normalStiffness, p.shearStiffness}; }

JointProperties head() {
    JointProperties p;
    p.name = "head";
    p.compressiveStrength = 5.93e6;
    p.compressiveFractureEnergy = 31500;
    return p;
}

struct Path {
    JointLaw law;
    ElasticStiffness k;
    JointState state{};
    Energies dissipated{};
    double work = 0;

    Path(const JointProperties& p, ElasticStiffness stiffness) : law(p), k(stiffness) {}
    explicit Path(const JointProperties& p) : Path(p, own(p)) {}

    void step(const Jump& jump) {
        const auto old = state;
        const auto lost = law.advance(k, state, jump);
        dissipated.tension += lost.tension;
        dissipated.shear += lost.shear;
        dissipated.compression += lost.compression;
        work += 0.5 * ((old.normalStress + state.normalStress) * jump.opening +
                       (old.shearStress.a + state.shearStress.a) * jump.slide.a +
                       (old.shearStress.b + state.shearStress.b) * jump.slide.b);
    }
    void move(
        const Jump& total, int steps, const std::function<void()>& look = [] {}) {
        for (int i = 0; i < steps; ++i) {
            step({total.opening / steps, {total.slide.a / steps, total.slide.b / steps}});
            look();
        }
    }
    double stored() const {
        const auto e = JointLaw::stored(k, state);
        return e.tension + e.shear + e.compression;
    }
    double lost() const { return dissipated.tension + dissipated.shear + dissipated.compression; }
};

// Approx adds 1 to the size of the numbers unless it is told another scale: nothing in metres would ever differ.
doctest::Approx within(double value, double relative) {
    return doctest::Approx(value).epsilon(relative).scale(value == 0 ? 1 : 0);
}

} // namespace

TEST_CASE("pulling a joint fully open peaks at ft and takes the mode I energy") {
    Path p(bed);
    double peak = 0, at = 0;
    p.move({0.6e-6, {}}, 600, [&] {
        if (p.state.normalStress > peak) peak = p.state.normalStress, at = p.state.opening;
    });
    p.move({3e-3, {}}, 300000);
    CHECK(peak == within(0.10e6, 0.005));
    CHECK(at == within(0.298e-6, 0.005)); // ft/kn
    CHECK(p.state.normalStress == 0);     // the last row of the table is damage 1
    CHECK(p.work == within(16, 0.005));
    CHECK(p.dissipated.tension == within(p.work, 1e-9));
    CHECK(p.lost() == within(p.dissipated.tension, 1e-12));
}

TEST_CASE("shearing a joint without normal stress peaks at the cohesion and takes the mode II energy") {
    Path p(bed);
    double peak = 0, at = 0;
    p.move({0, {1.5e-6, 0}}, 1500, [&] {
        if (p.state.shearStress.a > peak) peak = p.state.shearStress.a, at = p.state.slip + peak / p.k.shear;
    });
    p.move({0, {0.02, 0}}, 400000);
    CHECK(peak == within(0.11e6, 0.005));
    CHECK(at == within(0.761e-6, 0.005)); // cp/ks
    CHECK(p.state.shearStress.a == doctest::Approx(0).epsilon(1e-9));
    CHECK(p.work == within(160, 0.005));
    CHECK(p.dissipated.shear == within(p.work, 1e-9));
}

TEST_CASE("shearing under 0.5 MPa peaks on the Coulomb line, keeps friction, and softens in proportion to the peak") {
    Path p(bed);
    p.move({-0.5e6 / p.k.normal, {}}, 10);
    CHECK(p.state.normalStress == within(-0.5e6, 1e-12));
    double peak = 0, above = 0;
    const double residual = 0.43 * 0.5e6, length = 0.06;
    const int steps = 600000;
    p.move({0, {length, 0}}, steps, [&] {
        peak = std::max(peak, p.state.shearStress.a);
        if (p.state.slip > 0) above += (p.state.shearStress.a - residual) * length / steps;
    });
    CHECK(peak == within(0.325e6, 0.005));
    CHECK(p.state.shearStress.a == within(0.215e6, 1e-6));
    CHECK(above == within(473, 0.01)); // 160 * 0.325/0.11
}

TEST_CASE("closing a joint passes the elastic limit, the peak at ucp, fcm at ucm, and ends at the residual") {
    Path p(bed);
    const auto at = [&](double closure) {
        p.move({-closure - p.state.opening, {}}, 2000);
        return -p.state.normalStress;
    };
    CHECK(at(6.757e-6) == within(2.265e6, 0.001));
    CHECK(at(1.543e-3) == within(7.55e6, 0.001));
    CHECK(at(p.law.compression().middleClosure) == within(4.53e6, 0.001));
    CHECK(at(0.05) == within(1.51e6, 0.001));
    CHECK(p.dissipated.compression + p.stored() == within(p.work, 1e-9));
    CHECK(p.law.compression().softeningRatio == within(1.200, 0.001));
    CHECK(p.law.compression().middleClosure == within(1.851e-3, 0.001));
}

TEST_CASE("the head joint's compression curve has m = 3.780 and ucm = 4.580 mm") {
    const auto curve = JointLaw(head()).compression();
    CHECK(curve.softeningRatio == within(3.780, 0.001));
    CHECK(curve.middleClosure == within(4.580e-3, 0.001));
}

TEST_CASE("strength in compression and its slope are continuous at ucm") {
    const auto c = JointLaw(bed).compression();
    const double h = 1e-9, u = c.middleClosure;
    CHECK(c.strength(u - 1e-15) == within(c.strength(u + 1e-15), 1e-9));
    CHECK((c.strength(u) - c.strength(u - h)) / h == within((c.strength(u + h) - c.strength(u)) / h, 1e-3));
    CHECK(c.strength(c.limitClosure) == c.elasticLimit);
    CHECK(c.strength(c.peakClosure) == within(c.peak, 1e-12));
}

TEST_CASE("the exponential tables keep the area under the curve") {
    for (double decay : {0.001, 0.5, 30.}) {
        const auto rows = SofteningTable::exponential(decay);
        CHECK(rows.size() == 201);
        CHECK(SofteningTable::problems(rows).empty());
        double area = 0;
        for (std::size_t i = 0; i + 1 < rows.size(); ++i)
            area += (1 - 0.5 * (rows[i].damage + rows[i + 1].damage)) * (rows[i + 1].ratio - rows[i].ratio);
        CHECK(area * decay == within(1, 0.005));
    }
}

TEST_CASE("a table is linear between its rows and keeps its last damage") {
    const SofteningTable t({{1, 0}, {2, 0.5}, {4, 0.5}, {8, 0.9}});
    for (const auto& [ratio, damage] : std::vector<std::pair<double, double>>{
             {0, 0}, {1, 0}, {1.5, 0.25}, {2, 0.5}, {3, 0.5}, {6, 0.7}, {8, 0.9}, {100, 0.9}, {HUGE_VAL, 0.9}})
        CHECK(t.damage(ratio) == within(damage, 1e-15));
}

TEST_CASE("between two rows a table is never rounded up beyond the second") {
    const std::vector<TableRow> rows{
        {1, 0}, {1.1181633515928748, 0.25953858936155921}, {22.452930066744464, 0.66366387932763671}};
    const double last = std::nextafter(rows[2].ratio, 0);
    std::int32_t row = 1;
    CHECK(SofteningTable(rows).damage(last) <= rows[2].damage);
    CHECK(SofteningTable(rows).damage(last, row) <= rows[2].damage);
}

TEST_CASE("a crack unloads to the origin, closes without a push and carries compression again") {
    Path p(bed);
    p.move({40e-6, {}}, 100);
    const double top = p.state.normalStress;
    CHECK(top > 0);
    p.move({-20e-6, {}}, 100);
    CHECK(p.state.normalStress == within(0.5 * top, 1e-9));
    p.move({-20e-6, {}}, 100, [&] { CHECK(p.state.normalStress >= -1e-3); });
    CHECK(std::abs(p.state.normalStress) < 1e-3);
    p.move({-1e-6, {}}, 10);
    CHECK(p.state.normalStress == within(-1e-6 * p.k.normal, 1e-6));
}

TEST_CASE("slip in shear takes tensile strength along: damages are coupled") {
    Path p(bed);
    p.move({0, {2e-3, 0}}, 1000);
    const double damage = p.state.shearDamage;
    CHECK(damage > 0.5);
    double peak = 0;
    p.move({1e-6, {}}, 1000, [&] { peak = std::max(peak, p.state.normalStress); });
    CHECK(peak <= 0.10e6 * (1 - damage) * (1 + 1e-9));
    CHECK(peak > 0);
}

TEST_CASE("crushing leaves a plastic closure and unloads with the elastic stiffness") {
    Path p(bed);
    p.move({-2e-3, {}}, 2000);
    const double sigma = p.state.normalStress, closure = p.state.opening;
    p.move({1e-6, {}}, 10);
    CHECK(p.state.normalStress - sigma == within(1e-6 * p.k.normal, 1e-6));
    CHECK(p.state.crushing == within(-closure + sigma / p.k.normal, 1e-6));
}

TEST_CASE("a slipping joint with dilatancy opens by tan(psi) per slip, and decay stops it") {
    JointProperties q = bed;
    q.dilatancy = 0.2;
    for (double decay : {0., 2000.}) {
        q.dilatancyDecay = decay;
        Path p(q);
        p.move({-0.5e-6, {}}, 10);
        p.move({0, {5e-6, 0}}, 20000);
        const double s = p.state.slip;
        CHECK(s > 0);
        CHECK(p.state.dilation == within(decay == 0 ? 0.2 * s : 0.2 * (1 - std::exp(-decay * s)) / decay, 1e-3));
        CHECK(p.state.normalStress < -0.5e-6 * p.k.normal); // held shut, so dilatancy presses
    }
}

TEST_CASE("dilatancy dies away with the slip and ends at tan(psi) over its decay") {
    JointProperties q = bed;
    q.dilatancy = 0.2, q.dilatancyDecay = 2000, q.cap = false; // what it presses is 33 MPa
    Path p(q);
    p.move({0, {3e-3, 0}}, 20000);
    const double s = p.state.slip;
    CHECK(s > 2e-3); // 1 - exp(-2000 s) is 0.98 and more
    CHECK(p.state.dilation == within(0.2 * (1 - std::exp(-2000 * s)) / 2000, 1e-3));
    CHECK(p.state.normalStress == within(-p.k.normal * p.state.dilation, 1e-9));
}

TEST_CASE("the cap bounds shear and compression together, along the ray to the origin") {
    Path p(bed);
    p.step({-3e-3, {1e-3, 2e-3}});
    CHECK(p.state.regime == Regime::Crushing);
    const auto f = p.law.yield(p.k, p.state);
    CHECK(f.cap <= 1e-9 * 7.55e6 * 7.55e6);
    CHECK(p.state.shearStress.b / p.state.shearStress.a == within(2, 1e-12));
}

TEST_CASE("what a joint slides is the elastic part and its slip, by Coulomb and by crushing") {
    JointProperties strong = bed; // slips by crushing alone
    strong.cohesion = 1e9;
    for (const auto& properties : {strong, bed}) {
        Path p(properties);
        p.move({-1.5e-3, {}}, 1000);
        bool crushed = false;
        p.move({-0.2e-3, {0.3e-3, 0.4e-3}}, 20000,
               [&] { crushed |= p.state.regime == Regime::Crushing && p.state.slip > 0; });
        CHECK(crushed);
        const double elastic = std::hypot(p.state.shearStress.a, p.state.shearStress.b) / p.k.shear;
        CHECK(p.state.slip == within(0.5e-3 - elastic, 1e-6));
        CHECK(elastic < 0.1 * p.state.slip);
        CHECK(-p.state.opening == within(p.state.crushing - p.state.normalStress / p.k.normal, 1e-9));
    }
}

TEST_CASE("lumping the units into the joint changes the elastic part only") {
    const double E = 4.8e9, G = E / 2.32, L = 0.081;
    const auto k = inSeriesWithUnits(bed, L / E, L / G);
    CHECK(k.normal == within(5.04e10, 0.001));
    CHECK(k.shear == within(2.17e10, 0.002));
    Path own(bed), lumped(bed, k);
    own.move({3e-3, {}}, 300000), lumped.move({3e-3, {}}, 300000);
    const double elastic = 0.5 * 0.1e6 * 0.1e6; // the triangle before the peak, ft²/2k
    CHECK(lumped.work - elastic / k.normal == within(own.work - elastic / bed.normalStiffness, 0.001));

    Path ownShear(bed), lumpedShear(bed, k);
    ownShear.move({0, {0.02, 0}}, 400000), lumpedShear.move({0, {0.02, 0}}, 400000);
    const double triangle = 0.5 * 0.11e6 * 0.11e6;
    CHECK(lumpedShear.work - triangle / k.shear == within(ownShear.work - triangle / bed.shearStiffness, 0.001));

    const auto curve = lumped.law.compression();
    const double stretch = 1 / k.normal - 1 / bed.normalStiffness, peak = 7.55e6;
    for (double u : {1.6e-3, 1.8e-3, 2.5e-3, 9e-3}) // beyond the peak, shifted by the elastic part at the peak
        CHECK(curve.strength(u + peak * stretch, stretch) == within(curve.strength(u), 1e-9));

    Path crushed(bed, k); // and so for the law that reads it: its stress on the way down
    for (double u : {1.6e-3, 1.8e-3, 2.5e-3, 9e-3}) {
        crushed.move({-u - peak * stretch - crushed.state.opening, {}}, 2000);
        CHECK(-crushed.state.normalStress == within(curve.strength(u), 1e-6));
    }
}

TEST_CASE("the brittle Coulomb set drops at the first yield and never crushes") {
    Path tension(brittleCoulomb(bed));
    tension.move({0.31e-6, {}}, 1000);
    CHECK(tension.state.normalStress == 0);
    Path shear(brittleCoulomb(bed));
    shear.move({-0.5e6 / shear.k.normal, {}}, 10);
    shear.move({0, {4e-6, 0}}, 1000);
    CHECK(shear.state.shearStress.a == within(0.43 * 0.5e6, 1e-9));
    shear.move({-1e-3, {}}, 10);
    CHECK(shear.state.normalStress == within(-1e-3 * shear.k.normal - 0.5e6, 1e-9));
}

TEST_CASE("an elastic joint carries anything") {
    JointProperties q = bed;
    q.elastic = true;
    Path p(q);
    p.move({1e-3, {2e-3, -1e-3}}, 10);
    CHECK(p.state.normalStress == within(1e-3 * q.normalStiffness, 1e-12));
    CHECK(p.state.shearStress.a == within(2e-3 * q.shearStiffness, 1e-12));
    CHECK(p.work == within(p.stored(), 1e-12));
}

TEST_CASE("ten thousand steps or ten to the same end of a monotonic path give the same answer") {
    const auto same = [](Jump first, Jump then) {
        Path few(bed), many(bed);
        few.move(first, 1), many.move(first, 1);
        few.move(then, 10), many.move(then, 10000);
        const double size = std::abs(few.state.normalStress) + std::abs(few.state.shearStress.a);
        CHECK(std::abs(few.state.normalStress - many.state.normalStress) < 1e-9 * size);
        CHECK(std::abs(few.state.shearStress.a - many.state.shearStress.a) < 1e-9 * size);
    };
    for (double size : {1e-6, 1e-5, 1e-4, 1e-3}) {
        same({}, {size, {}});
        same({}, {-3 * size, {}});
        same({-0.5e6 / bed.normalStiffness, {}}, {0, {size, 0}});
    }
}

TEST_CASE("refusals name the joint, the value with its unit and the bound, all at once") {
    const auto refused = [](const std::function<void(JointProperties&)>& spoil) {
        JointProperties p;
        spoil(p);
        try {
            JointLaw law(p);
        } catch (const std::invalid_argument& e) {
            return std::string(e.what());
        }
        return std::string("accepted");
    };
    using P = JointProperties;
    const double nan = std::nan("");
    CHECK(refused([](P&) {}) == "accepted");
    CHECK(refused([](P& p) { p.compressiveFractureEnergy = 12000; }) ==
          "joint \"bed\": compressive fracture energy 12000 J/m² is too small for peak ratio 68.5 (needs at least "
          "12208 J/m²)");
    CHECK(refused([](P& p) { p.compressiveFractureEnergy = 12208; }) == "accepted");
    CHECK(refused([](P& p) { p.name = "", p.tensileStrength = -1; }) ==
          "joint \"\": name must not be empty\njoint \"\": tensile strength -1 Pa must be at least 0");
    const struct {
        std::function<void(P&)> spoil;
        const char* message;
    } cases[] = {
        {[](P& p) { p.normalStiffness = 0; }, "normal stiffness 0 Pa/m must be above 0"},
        {[=](P& p) { p.shearStiffness = nan; }, "shear stiffness nan Pa/m must be a finite number"},
        {[](P& p) { p.tensileStrength = 0.3e6; },
         "tensile strength 300000 Pa is above the apex of the Coulomb cone, cohesion/friction = 255814 Pa"},
        {[](P& p) { p.cohesion = -2; }, "cohesion -2 Pa must be at least 0"},
        {[](P& p) { p.residualCohesion = 0.2e6; }, "residual cohesion 200000 Pa must be at most 110000"},
        {[](P& p) { p.friction = -0.1; }, "friction -0.1 must be at least 0"},
        {[](P& p) { p.residualFriction = 0.5; }, "residual friction 0.5 must be at most 0.43"},
        {[](P& p) { p.dilatancy = 0.44; }, "dilatancy 0.44 must be at most 0.43"},
        {[](P& p) { p.dilatancyDecay = -1; }, "dilatancy decay -1 1/m must be at least 0"},
        {[](P& p) { p.modeIFractureEnergy = 0; }, "mode I fracture energy 0 J/m² must be above 0"},
        {[](P& p) { p.modeIIFractureEnergy = -1; }, "mode II fracture energy -1 J/m² must be above 0"},
        {[](P& p) { p.tensileStrength = 1e-160; }, // its square is no number, and 0/0 in the table was none either
         "mode I strength 1e-160 Pa, stiffness 3.352e+11 Pa/m and fracture energy 16 J/m² are too far apart for an "
         "exponential table"},
        {[](P& p) { p.compressiveStrength = 0; }, "compressive strength 0 Pa must be above 0"},
        {[](P& p) { p.elasticLimitRatio = 1; }, "elastic limit ratio 1 must be at most 0.999"},
        {[](P& p) { p.residualStrengthRatio = 1; }, "residual strength ratio 1 must be at most 0.999"},
        {[](P& p) { p.peakRatio = 0.5; }, "peak ratio 0.5 must be at least 1"},
        {[](P& p) { p.capNormal = 0; }, "cap constant Cnn 0 must be above 0"},
        {[](P& p) { p.capShear = -1; }, "cap constant Css -1 must be at least 0"},
        {[](P& p) {
             p.tensionTable = {{1, 0}};
         },
         "tension table, needs at least two rows, has 1"},
        {[](P& p) {
             p.tensionTable = {{1.1, 0}, {2, 1}};
         },
         "tension table, row 1: must be ratio 1, damage 0 (the peak), is 1.1, 0"},
        {[](P& p) {
             p.shearTable = {{1, 0}, {2, 0.5}, {2, 1}};
         },
         "shear table, row 3: ratio 2 must be above 2 of the row before"},
        {[](P& p) {
             p.shearTable = {{1, 0}, {2, 0.5}, {3, 0.4}};
         },
         "shear table, row 3: damage 0.4 falls below 0.5 of the row before"},
        {[](P& p) {
             p.shearTable = {{1, 0}, {2, 1.5}};
         },
         "shear table, row 2: damage 1.5 is outside 0 to 1"},
        {[=](P& p) {
             p.shearTable = {{1, 0}, {nan, 1}};
         },
         "shear table, row 2: ratio and damage must be finite numbers"},
        {[](P& p) { p.cohesion = p.tensileStrength = 0, p.residualFriction = 0.3; },
         "friction softens from 0.43 to 0.3 without cohesion: give a shear table, no exponential one follows from zero "
         "cohesion"},
    };
    for (const auto& c : cases)
        CHECK(refused(c.spoil) == std::string("joint \"bed\": ") + c.message);
}

// ---- random paths ------------------------------------------------------------------------------------------------

namespace {

struct Dice {
    std::mt19937_64 engine;
    double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine); }
    double logarithmic(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
    bool chance(double p) { return between(0, 1) < p; }

    JointProperties properties() {
        JointProperties p;
        p.normalStiffness = logarithmic(1e9, 1e13);
        p.shearStiffness = p.normalStiffness * between(0.1, 1);
        p.friction = chance(0.1) ? 0 : between(0, 2);
        p.residualFriction = p.friction * (chance(0.3) ? 1 : between(0, 1));
        p.cohesion = chance(0.1) ? 0 : logarithmic(1e2, 1e8);
        if (p.cohesion == 0) p.residualFriction = p.friction;
        p.residualCohesion = p.cohesion * (chance(0.5) ? 0 : between(0, 1));
        p.tensileStrength = p.friction > 0 ? std::min(1e9, p.cohesion / p.friction) * between(0, 1) : p.cohesion;
        p.dilatancy = chance(0.5) ? 0 : p.residualFriction * between(0, 1);
        p.dilatancyDecay = chance(0.5) ? 0 : logarithmic(1, 1e5);
        p.modeIFractureEnergy = logarithmic(0.1, 1e3);
        p.modeIIFractureEnergy = logarithmic(0.1, 1e4);
        if (chance(0.3)) p.tensionTable = {{1, 0}, {between(1.1, 5), between(0, 0.5)}, {50, between(0.5, 1)}};
        if (chance(0.3)) p.shearTable = SofteningTable::brittle();
        p.cap = chance(0.8);
        p.compressiveStrength = logarithmic(1e5, 1e9);
        p.elasticLimitRatio = between(0.05, 0.95);
        p.residualStrengthRatio = chance(0.3) ? 0 : between(0, 0.95);
        p.peakRatio = logarithmic(1, 100);
        p.compressiveFractureEnergy =
            CompressionCurve::smallestFractureEnergy(p.normalStiffness, p.compressiveStrength, p.elasticLimitRatio,
                                                     p.residualStrengthRatio, p.peakRatio) *
            logarithmic(1.01, 10);
        p.capShear = chance(0.2) ? 0 : logarithmic(0.1, 100);
        p.capNormal = logarithmic(0.1, 10);
        p.capLinear = chance(0.5) ? 0 : between(-0.3, 0.3) * p.compressiveStrength;
        return p;
    }
};

} // namespace

TEST_CASE("on a million random steps no yield surface is passed, nothing heals and energy is accounted for") {
    Dice dice{std::mt19937_64(20261121)};
    for (int set = 0; set < 500; ++set) {
        const auto p = dice.properties();
        REQUIRE(p.problems().empty());
        const double softer = dice.chance(0.5) ? 1 : dice.between(0.05, 1);
        Path path(p, {p.normalStiffness * softer, p.shearStiffness * softer});
        const double reach =
            (std::max(p.tensileStrength, p.cohesion) + (p.cap ? p.compressiveStrength : 0) + 1) / path.k.normal;
        double scale = p.cohesion + p.tensileStrength, work = 0;
        for (int i = 0; i < 2000; ++i) {
            const double size = reach * dice.logarithmic(1e-4, i % 100 == 0 ? 1e3 : 1);
            const Jump jump{size * dice.between(-1, 1), {size * dice.between(-1, 1), size * dice.between(-1, 1)}};
            const auto old = path.state;
            path.step(jump);
            const auto& s = path.state;
            const double stress = std::abs(s.normalStress) + std::hypot(s.shearStress.a, s.shearStress.b);
            scale = std::max(scale, stress + path.k.normal * size);
            work += std::abs(path.work);
            bool fine = std::isfinite(stress + s.opening + s.crushing + s.dilation + s.slip + path.lost());
            const auto f = path.law.yield(path.k, s); // round-off of the trial stress, not of the strength
            fine &= f.tension <= 1e-12 * scale && f.slip <= 1e-12 * scale && f.cap <= 1e-11 * scale * scale;
            fine &= s.tensionDamage >= old.tensionDamage && s.shearDamage >= old.shearDamage && s.slip >= old.slip &&
                    s.crushing >= old.crushing && s.dilation >= old.dilation &&
                    s.largestOpening >= old.largestOpening && s.largestClosure >= old.largestClosure;
            fine &= s.tensionDamage <= 1 && s.shearDamage <= 1;
            if (!fine) FAIL("set " << set << ", step " << i);
        }
        CHECK(std::abs(path.work - path.stored() - path.lost()) <= 1e-9 * work);
    }
}

TEST_CASE("small random steps never create energy") {
    Dice dice{std::mt19937_64(7)};
    for (int set = 0; set < 100; ++set) {
        auto p = dice.properties();
        if (p.tensionTable.empty() == false || p.shearTable.empty() == false) continue; // brittle drops are jumps
        Path path(p);
        const double small = 1e-3 *
                             std::min({p.tensileStrength > 0 ? p.tensileStrength : HUGE_VAL,
                                       p.cohesion > 0 ? p.cohesion : HUGE_VAL, p.compressiveStrength}) /
                             path.k.normal;
        Jump drift{};
        double largest = 0;
        for (int i = 0; i < 5000; ++i) {
            if (i % 500 == 0) drift = {dice.between(-1, 1), {dice.between(-1, 1), dice.between(-1, 1)}};
            path.step({small * drift.opening, {small * drift.slide.a, small * drift.slide.b}});
            largest = std::max(largest, path.lost() + path.stored());
            CHECK(path.lost() >= -1e-3 * largest);
        }
    }
}

TEST_CASE("turning the slide turns the shear stress") {
    Dice dice{std::mt19937_64(3)};
    const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
    Path straight(bed), turned(bed);
    for (int i = 0; i < 10000; ++i) {
        const double n = dice.between(-2e-6, 1e-6), a = dice.between(-2e-6, 3e-6), b = dice.between(-1e-6, 1e-6);
        straight.step({n, {a, b}});
        turned.step({n, {c * a - s * b, s * a + c * b}});
        const auto& t = straight.state.shearStress;
        const double size = 1e-9 * (std::hypot(t.a, t.b) + 1e3);
        REQUIRE(std::abs(turned.state.shearStress.a - (c * t.a - s * t.b)) < size);
        REQUIRE(std::abs(turned.state.shearStress.b - (s * t.a + c * t.b)) < size);
        REQUIRE(std::abs(turned.state.normalStress - straight.state.normalStress) < size);
    }
}

TEST_CASE("subcontacts in columns follow the law one by one, whatever kind, jump and neighbour") {
    Dice dice{std::mt19937_64(11)};
    constexpr int size = 37;
    for (int set = 0; set < 200; ++set) {
        auto p = dice.properties();
        p.elastic = dice.chance(0.05);
        const double softer = dice.chance(0.5) ? 1 : dice.between(0.05, 1);
        const ElasticStiffness k{p.normalStiffness * softer, p.shearStiffness * softer};
        std::vector<Path> paths(size, Path(p, k));
        const JointLaw& law = paths[0].law;
        JointColumns columns(law, k, size);
        const bool plane = set % 3 == 0; // no slides along b
        const double reach =
            (std::max(p.tensileStrength, p.cohesion) + (p.cap ? p.compressiveStrength : 0) + 1) / k.normal;
        std::vector<double> n(size), a(size), b(size), sigma(size), largest(size, 1.0);
        for (int step = 0; step < 300; ++step) {
            const double common = reach * dice.logarithmic(1e-4, 1);
            for (int i = 0; i < size; ++i) {
                n[i] = common * dice.between(-1, 1), a[i] = common * dice.between(-1, 1);
                b[i] = plane ? 0 : common * dice.between(-1, 1);
                paths[i].step({n[i], {a[i], b[i]}});
                largest[i] = std::max(largest[i], k.normal * (std::abs(paths[i].state.opening) + 3 * common));
            }
            const int half = dice.between(0, size); // ranges of any size and place
            columns.advance(law, 0, half, &n[0], &a[0], plane ? nullptr : &b[0], &sigma[0]);
            columns.advance(law, half, size - half, &n[half], &a[half], plane ? nullptr : &b[half], &sigma[half]);
        }
        for (int i = 0; i < size; ++i) {
            const auto &one = paths[i].state, other = columns.get(i);
            const double stress = 1e-11 * largest[i], length = stress / k.normal;
            bool same = std::abs(one.normalStress - other.normalStress) <= stress &&
                        std::abs(one.normalStress - sigma[i]) <= stress &&
                        std::abs(one.shearStress.a - other.shearStress.a) <= stress &&
                        std::abs(one.shearStress.b - other.shearStress.b) <= stress;
            same &= std::abs(one.opening - other.opening) <= length &&
                    std::abs(one.crushing - other.crushing) <= length &&
                    std::abs(one.dilation - other.dilation) <= length && std::abs(one.slip - other.slip) <= length &&
                    (p.elastic || std::abs(one.largestOpening - other.largestOpening) <= length) &&
                    std::abs(one.largestClosure - other.largestClosure) <= length;
            same &= std::abs(one.tensionDamage - other.tensionDamage) <= 1e-9 &&
                    std::abs(one.shearDamage - other.shearDamage) <= 1e-9 && one.regime == other.regime;
            const double energy = 1e-9 * largest[i] * largest[i] / k.normal;
            const auto lost = columns.dissipated(i);
            same &= std::abs(paths[i].dissipated.tension - lost.tension) <= energy &&
                    std::abs(paths[i].dissipated.shear - lost.shear) <= energy &&
                    std::abs(paths[i].dissipated.compression - lost.compression) <= energy;
            if (!same) FAIL("set " << set << ", subcontact " << i);
        }
    }
}
