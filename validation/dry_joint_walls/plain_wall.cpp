// SPDX-License-Identifier: GPL-2.0-or-later
// A plain model of a dry-joint granite wall, in two dimensions and written without the plugin, so that both can be held
// against each other and properties can be tried that no joint law of the plugin has. plain_wall.py compiles and runs
// it.
//
// Rigid blocks in running bond, small displacements, explicit steps. Joints have no tension and no cohesion; their
// points are the middles of equal parts. Closed: the hyperbola kn0 c / (1 - c/cm) up to the tangent kn, straight from
// there; the elasticity of the blocks is in series. Shear: spring and Coulomb friction. Loads as in
// scripts/gallery/wall_dry.py: the vertical load keeps its line, the top is driven 1.325 m above the base, directly or
// through a spring.
//
// For hypotheses on the loops (README.md, Loops): a cap, friction that wears off, shear stiffness by pressure, head
// joints with a gap or without friction, soft joints at base and top, stones without elasticity, a load that rides,
// rollers with friction.
//
// plain_wall NAME=VALUE ... < turning points [mm]; SI units but for level [kN], rate [mm/s] and every [mm].
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>
#include <vector>

namespace {

constexpr double half = 0.1, height = 0.15, thickness = 0.2, loadHeight = 1.325; // [m] half block, course, wall
constexpr double density = 2600, young = 20.2e9, poisson = 0.2, gravity = 9.81;
constexpr int courses = 8, halves = 10;

struct Block {
    double x0, x1, z0, z1, x, z; // sides and centre [m]
    double mass, inertia;
    double at[3] = {}, velocity[3] = {}, force[3] = {}, before[3] = {}; // along, up, turn
};

struct Point {
    int lower, upper;        // or left and right
    double ax, az, bx, bz;   // from the centres of both blocks [m]
    double area;             // [m²]
    bool bed;                // or head
    double softness;         // of the blocks in series [m/Pa]
    double shearStiffness;   // with the blocks in series [Pa/m]
    double closingStiffness; // largest, for the time step and the friction of closing [Pa/m]
    double shearSoftness;    // of the blocks in series [m/Pa]
    double gap, friction;    // of a head joint [m], [-]
    double factor;           // of kn, kn0 and ks
    double opening = 0, slide = 0, shear = 0, closing = 0; // closing: stress of the friction of closing [Pa]
    double crushed = 0, slip = 0;                          // closure beyond the cap, accumulated slip [m]
};

std::map<std::string, double> options = {
    {"level", 175},         {"kn", 34e9}, {"kn0", 0},    {"cm", 0},       {"ks", 13.6e9},
    {"friction", 0.65},     {"rate", 50}, {"points", 8}, {"every", 0.05}, {"damping", 0.8},
    {"closingFriction", 0}, {"rig", 0}, // stiffness of a spring between the drive and the top [N/m]; 0: none
    {"cap", 1e12},                      // pressure at which a point yields [Pa]; it unloads with its whole stiffness
    {"worn", -1},         // friction that is left after much slip, decaying over 10 mm of it; below 0: it does not wear
    {"shearPower", 0},    // ks grows with the pressure over that of the vertical load, by this power
    {"headGap", 0},       // opening of head joints before the test [m]
    {"headFriction", -1}, // of head joints; below 0: as of bed joints
    {"supportFactor", 1}, // stiffness of the joints to base and top over that of the others
    {"rigid", 0},         // 1: stones without elasticity
    {"riding", 0},        // 1: the vertical load moves with the top
    {"rollers", 0}};      // friction of rollers under the vertical load
constexpr double wear = 10e-3, leastShear = 0.02; // [m]; least ks by pressure over ks

// Pressure of a closed point [Pa]: the joint's curve in series with the blocks.
double pressure(double closure, double softness, double factor) {
    static const double own = options["kn"], first = options["kn0"], limit = options["cm"];
    const double kn = factor * own, kn0 = factor * first;
    const double straight = 1 / (1 / kn + softness);
    if (kn0 <= 0) return straight * closure;
    const double scale = kn0 * limit, end = scale * (std::sqrt(kn / kn0) - 1);
    const double endClosure = end * limit / (scale + end) + end * softness;
    if (closure >= endClosure) return end + (closure - endClosure) * straight;
    const double b = limit + scale * softness - closure;
    return (-b + std::sqrt(b * b + 4 * softness * scale * closure)) / (2 * softness);
}

} // namespace

int main(int count, char** words) {
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const auto equals = word.find('=');
        const std::string name = word.substr(0, equals);
        if (equals == std::string::npos || !options.count(name)) {
            std::fprintf(stderr, "no option %s\n", word.c_str());
            return 2;
        }
        options[name] = std::atof(word.c_str() + equals + 1);
    }
    std::vector<double> targets;
    for (double x; std::cin >> x;)
        targets.push_back(x * 1e-3);

    std::vector<Block> blocks;
    const auto add = [&](double x0, double x1, double z0, double z1) {
        Block b{x0, x1, z0, z1, (x0 + x1) / 2, (z0 + z1) / 2, 0, 0};
        b.mass = density * thickness * (x1 - x0) * (z1 - z0);
        b.inertia = b.mass * ((x1 - x0) * (x1 - x0) + (z1 - z0) * (z1 - z0)) / 12;
        blocks.push_back(b);
        return int(blocks.size()) - 1;
    };
    std::vector<std::vector<int>> rows;
    for (int course = 0; course < courses; ++course) {
        std::vector<int> edges{0}, row;
        for (int edge = course % 2 ? 1 : 2; edge < halves; edge += 2)
            edges.push_back(edge);
        edges.push_back(halves);
        for (std::size_t i = 0; i + 1 < edges.size(); ++i)
            row.push_back(add(edges[i] * half, edges[i + 1] * half, course * height, (course + 1) * height));
        rows.push_back(row);
    }
    const int top = add(0, halves * half, courses * height, loadHeight);
    blocks[top].z = loadHeight; // its centre is the driven point; its mass only has to be small against the load
    blocks[top].mass = 2000;
    blocks[top].inertia = 400;
    rows.push_back({top});
    const int base = add(0, halves * half, -0.2, 0);

    std::vector<Point> points;
    const double shear = young / (2 * (1 + poisson));
    const auto join = [&](int a, int b, double x, double z, bool bed, double area) {
        Point p{a, b, x - blocks[a].x, z - blocks[a].z, x - blocks[b].x, z - blocks[b].z, area, bed};
        const double apart = (bed ? height : 2 * half) * (a == base || b == top ? 0.5 : 1); // of the centres
        const bool rigid = options["rigid"] > 0, bare = !bed && options["headFriction"] >= 0;
        p.softness = rigid ? 1e-14 : apart / young;
        p.shearSoftness = rigid ? 1e-14 : apart / shear;
        p.factor = a == base || b == top ? options["supportFactor"] : 1;
        p.shearStiffness = 1 / (1 / (p.factor * options["ks"]) + p.shearSoftness);
        p.closingStiffness = 1 / (1 / (p.factor * options["kn"]) + p.softness);
        p.gap = bed ? 0 : options["headGap"];
        p.friction = options[bare ? "headFriction" : "friction"];
        points.push_back(p);
    };
    std::vector<int> under{base};
    const int along = int(options["points"]); // of a joint of a half block
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const double z = r * height;
        for (int b : rows[r])
            for (int a : under) {
                const double low = std::max(blocks[a].x0, blocks[b].x0), high = std::min(blocks[a].x1, blocks[b].x1);
                if (high - low < 1e-9) continue;
                const int n = along * int(std::lround((high - low) / half));
                for (int i = 0; i < n; ++i)
                    join(a, b, low + (i + 0.5) * (high - low) / n, z, true, (high - low) * thickness / n);
            }
        for (std::size_t i = 0; i + 1 < rows[r].size(); ++i)
            for (int j = 0; j < along; ++j)
                join(rows[r][i], rows[r][i + 1], blocks[rows[r][i]].x1, z + (j + 0.5) * height / along, false,
                     height * thickness / along);
        under = rows[r];
    }

    std::vector<double> stiff(blocks.size()), turning(blocks.size());
    const double power = options["shearPower"], stiffest = power > 0 ? 5 : 1; // most ks by pressure, over ks
    for (const Point& p : points) {
        const double k =
            2 * p.area *
            std::max(p.closingStiffness * (1 + 4 * options["closingFriction"]), stiffest * p.shearStiffness);
        stiff[p.lower] += k;
        stiff[p.upper] += k;
        turning[p.lower] += k * (p.ax * p.ax + p.az * p.az + std::abs(p.ax * p.az));
        turning[p.upper] += k * (p.bx * p.bx + p.bz * p.bz + std::abs(p.bx * p.bz));
    }
    double fastest = 0;
    for (int i = 0; i < base; ++i)
        fastest = std::max({fastest, stiff[i] / blocks[i].mass, turning[i] / blocks[i].inertia});
    const double dt = 0.8 / std::sqrt(fastest);

    const double rig = options["rig"];
    double load = 0, velocity = 0, damping = 0.7;
    double drive = 0, pull = 0; // displacement [m] of the drive and its force [N]
    const double closing = options["closingFriction"], cap = options["cap"], worn = options["worn"], ks = options["ks"],
                 riding = options["riding"], usual = options["level"] * 1e3 / (halves * half * thickness);
    const auto step = [&] {
        for (Block& b : blocks) {
            b.force[0] = b.force[2] = 0;
            b.force[1] = -b.mass * gravity;
        }
        blocks[top].force[1] = -load;
        blocks[top].force[2] -= riding * load * blocks[top].at[0];
        for (Point& p : points) {
            Block &a = blocks[p.lower], &b = blocks[p.upper];
            const double x = b.at[0] - b.at[2] * p.bz - a.at[0] + a.at[2] * p.az;
            const double z = b.at[1] + b.at[2] * p.bx - a.at[1] - a.at[2] * p.ax;
            const double opening = (p.bed ? z : x) + p.gap, slide = p.bed ? x : z;
            double normal = 0;
            if (opening < 0) {
                const double trialPressure = std::max(pressure(-opening - p.crushed, p.softness, p.factor), 0.0);
                const double pressed = std::min(trialPressure, cap);
                p.crushed += (trialPressure - pressed) / p.closingStiffness;
                const double most = closing * pressed; // friction of closing: a second spring with a slider
                const double trial = p.closing - 4 * closing * p.closingStiffness * (opening - p.opening);
                p.closing = std::clamp(trial, -most, most);
                normal = -(pressed + p.closing);
                const double lost = worn < 0 ? 0 : (p.friction - worn) * (1 - std::exp(-p.slip / wear));
                const double limit = (p.friction - lost) * pressed;
                double stiffness = p.shearStiffness;
                if (power > 0) {
                    const double own = ks * std::max(leastShear, std::pow(pressed / usual, power));
                    stiffness = std::min(1 / (1 / own + p.shearSoftness), stiffest * stiffness);
                }
                const double sheared = p.shear + stiffness * (slide - p.slide);
                p.shear = std::clamp(sheared, -limit, limit);
                p.slip += std::abs(sheared - p.shear) / stiffness;
            } else
                p.shear = p.closing = 0;
            p.opening = opening;
            p.slide = slide;
            const double fx = (p.bed ? p.shear : normal) * p.area, fz = (p.bed ? normal : p.shear) * p.area;
            a.force[0] += fx;
            a.force[1] += fz;
            a.force[2] += fz * p.ax - fx * p.az;
            b.force[0] -= fx;
            b.force[1] -= fz;
            b.force[2] -= fz * p.bx - fx * p.bz;
        }
        drive += velocity * dt;
        pull = rig > 0 ? rig * (drive - blocks[top].at[0]) : -blocks[top].force[0];
        if (rig > 0) blocks[top].force[0] += pull;
        const auto sign = [](double x) { return (x > 0) - (x < 0); };
        for (int i = 0; i < base; ++i) {
            Block& b = blocks[i];
            for (int d = 0; d < 3; ++d) {
                // Cundall's combined damping
                const double f = b.force[d] + 0.5 * damping * std::abs(b.force[d]) *
                                                  (sign(b.force[d] - b.before[d]) - sign(b.velocity[d]));
                b.before[d] = b.force[d];
                b.velocity[d] += f / (d == 2 ? b.inertia : b.mass) * dt;
            }
            if (i == top && rig <= 0) b.velocity[0] = velocity;
            for (int d = 0; d < 3; ++d)
                b.at[d] += b.velocity[d] * dt;
        }
    };

    const long growing = std::lround(0.05 / dt);
    for (long i = 0; i < 3 * growing; ++i) {
        const double x = std::min(1.0, double(i) / growing);
        load = options["level"] * 1e3 * x * x * (3 - 2 * x);
        step();
    }
    damping = options["damping"];
    const double rate = options["rate"] * 1e-3, ramp = 0.02;
    double last = 0, now = 0;
    std::printf("displacement_mm,force_kN\n0,0\n");
    for (double target : targets) {
        const double direction = target > now ? 1 : -1;
        for (double time = dt;; time += dt) {
            const double left = (target - drive) * direction;
            if (left < 1e-9) break;
            const double brake = std::max(0.02 * rate, std::sqrt(2 * rate / ramp * left));
            velocity = direction * std::min({rate * std::min(1.0, time / ramp), brake, left / dt});
            step();
            const double moved = drive;
            if (std::abs(moved - last) * 1e3 >= options["every"]) {
                std::printf("%.5f,%.4f\n", moved * 1e3, (pull + direction * options["rollers"] * load) * 1e-3);
                last = moved;
            }
        }
        now = target;
    }
}
