// SPDX-License-Identifier: GPL-2.0-or-later
// A plain model of the wall COMP-4, in two dimensions and written without the plugin: one point after the other,
// without vector instructions of its own, on one thread. It shows what a step costs that does nothing but the model,
// and holds peak and work against the plugin's. plain.py compiles and runs it.
//
// Units are half bricks with crack surfaces between them. Displacements are small, steps explicit:
// - plane=0: three degrees of freedom, the elasticity of the units lumped into the joints,
// - plane=1: 2 x 2 cells of four triangles of plane stress, 13 nodes a half brick.
// A joint has three points, with 1/6, 4/6 and 1/6 of its area. The joint law is the paper's as law/README.md states it,
// with the exponential itself in place of its table of 200 rows.
//
// plain_comp4 NAME=VALUE ...; prints the curve, and on the error stream steps of the push, seconds, peak [kN] and
// work [J].
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

namespace {

constexpr int columns = 36, courses = 34;
constexpr double half = 0.11, height = 0.081, thickness = 0.102, length = columns * half; // [m]
constexpr double density = 1800, young = 4.8e9, poisson = 0.16, gravity = 9.81, pressure = 0.5e6;
constexpr double platenMass = 145.4; // [kg]

std::map<std::string, double> options = {{"rate", 100},     {"until", 12}, {"damping", 0.8},
                                         {"fraction", 0.8}, {"plane", 0},  {"every", 0.01}};

struct Joint { // properties of a kind of joints; SI units
    double ownKn, ownKs, kn, ks;
    bool elastic;
    double ft, cp, tanPhi, tension, shear; // `tension` and `shear`: g - 1/2 of the exponentials
    bool cap;
    double fel, fcp, fcr, uel, ucp, ucm, alpha;
};

Joint jointOf(double kn, double ks, double ft, double gI, double cp, double gII, double tanPhi, double fcp, double gc,
              double lumped, bool elastic, bool cap) {
    Joint j{};
    j.ownKn = kn;
    j.ownKs = ks;
    const double shear = young / (2 * (1 + poisson));
    j.kn = 1 / (1 / kn + lumped / young);
    j.ks = 1 / (1 / ks + 0.5 * lumped / shear); // half bricks share their shear between bed and head joints
    j.elastic = elastic;
    j.ft = ft;
    j.cp = cp;
    j.tanPhi = tanPhi;
    j.tension = kn * gI / (ft * ft) - 0.5;
    j.shear = ks * gII / (cp * cp) - 0.5;
    j.cap = cap;
    j.fcp = fcp;
    j.fel = 0.3 * fcp;
    j.fcr = 0.2 * fcp;
    j.uel = j.fel / kn;
    j.ucp = 68.5 * fcp / kn;
    const double kappa = j.ucp * fcp, xi = j.ucp * j.fcr, fcm = (fcp + j.fcr) / 2;
    const double m =
        (gc - fcp * fcp / (18 * kn) - 0.65 * (j.ucp - j.uel) * fcp + 0.75 * kappa + 0.25 * xi) / (kappa + xi);
    j.ucm = m * j.ucp;
    j.alpha = 2 * (fcm - fcp) / (j.ucm - j.ucp);
    return j;
}

// Damage at a displacement ratio, for a table whose rows are moved by `shift` (1 - d) for lumped units.
double damage(double g, double ratio, double shift) {
    if (ratio <= 1 + shift) return 0;
    double e = 1; // what is left of the bond
    if (ratio > 1 + g * 11.5) return 1;
    for (int i = 0; i < 50; ++i) { // 1 - g ln e + shift e = ratio, by Newton's method on ln e
        const double f = 1 - g * std::log(e) + shift * e - ratio, slope = -g + shift * e;
        const double step = std::clamp(-f / slope, -1.0, 1.0);
        e = std::min(1.0, e * std::exp(step));
        if (std::abs(step) < 1e-10) break;
    }
    return 1 - e;
}

double curve(const Joint& j, double u) { // compressive strength at a closure of the joint alone
    const double fcm = (j.fcp + j.fcr) / 2;
    if (u <= j.uel) return j.fel;
    if (u <= j.ucp) {
        const double x = (u - j.uel) / (j.ucp - j.uel);
        return j.fel + (j.fcp - j.fel) * std::sqrt(2 * x - x * x);
    }
    if (u <= j.ucm) {
        const double x = (u - j.ucp) / (j.ucm - j.ucp);
        return j.fcp + (fcm - j.fcp) * x * x;
    }
    return j.fcr + (fcm - j.fcr) * std::exp(j.alpha * (u - j.ucm) / (fcm - j.fcr));
}

double strength(const Joint& j, double closure) { // the same at a closure of joint and lumped units
    const double soft = 1 / j.kn - 1 / j.ownKn;
    if (soft <= 0) return curve(j, closure);
    double low = 0, high = closure; // u + fc(u) soft = closure
    if (closure <= j.uel + j.fel * soft) return j.fel;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (middle + curve(j, middle) * soft < closure ? low : high) = middle;
    }
    return curve(j, low);
}

struct Point {
    double un = 0, us = 0;                     // opening and slide [m]
    double sigma = 0, tau = 0;                 // [Pa]
    double widest = 0, tension = 0, shear = 0; // largest elastic opening [m], damages
    double slip = 0, crushed = 0, closed = 0;  // [m]
};

void advance(const Joint& j, Point& p, double un, double us) {
    const double trial = p.tau + j.ks * (us - p.us);
    p.un = un;
    p.us = us;
    if (j.elastic) {
        p.sigma = j.kn * un;
        p.tau = trial;
        return;
    }
    const double normalShift = (1 / j.kn - 1 / j.ownKn) * j.ownKn, shearShift = (1 / j.ks - 1 / j.ownKs) * j.ownKs;
    const double ue = un + p.crushed;
    if (ue > p.widest) {
        p.widest = ue;
        p.tension = std::max(p.tension, damage(j.tension, ue * j.ownKn / j.ft, (1 - p.shear) * normalShift));
    }
    double intact = (1 - p.tension) * (1 - p.shear);
    p.sigma = ue > 0 ? std::min(j.kn, j.ft * intact / p.widest) * ue : j.kn * ue;
    p.tau = trial;
    const double size = std::abs(trial), pressed = std::min(p.sigma, 0.0);
    double limit = std::max(0.0, j.cp * intact - p.sigma * j.tanPhi);
    if (size > limit) {
        const double peak = j.cp - p.sigma * j.tanPhi, rest = std::min(-pressed * j.tanPhi, peak) / peak;
        const double ratio = (p.slip + size / j.ks) * j.ownKs / peak - rest * shearShift;
        const double d = peak > 0 ? damage(j.shear, ratio, (1 - p.tension) * (1 - rest) * shearShift) : 1;
        if (d > p.shear) {
            p.shear = d;
            if (normalShift > 0 && p.widest > 0)
                p.tension =
                    std::max(p.tension, damage(j.tension, p.widest * j.ownKn / j.ft, (1 - p.shear) * normalShift));
            intact = (1 - p.tension) * (1 - p.shear);
            limit = std::max(0.0, j.cp * intact - p.sigma * j.tanPhi);
        }
        if (size > limit) {
            p.slip += (size - limit) / j.ks;
            p.tau = std::copysign(limit, trial);
        }
        if (ue > 0) p.sigma = std::min(j.kn, j.ft * intact / p.widest) * ue;
    }
    if (!j.cap) return;
    if (p.sigma < 0) p.closed = std::max(p.closed, -un);
    const double low = std::min(p.sigma, 0.0), stress = low * low + 9 * p.tau * p.tau;
    if (stress <= j.fcr * j.fcr) return;
    const double fc = strength(j, p.closed);
    if (stress <= fc * fc) return;
    const double share = fc / std::sqrt(stress);
    if (p.sigma < 0) {
        p.crushed += (low * share - low) / j.kn;
        p.sigma *= share;
    }
    p.slip += (1 - share) * std::abs(p.tau) / j.ks;
    p.tau *= share;
}

// How a point hangs on its unit: by the unit's own motion (rigid), or by one node (plane).
struct Side {
    int first;     // first degree of freedom
    double ax, az; // arm from the centre [m]; rigid units only
};
struct Place {
    Side sides[2];
    int kind;
    double area;
    bool bed;
    Point state;
};

} // namespace

int main(int count, char** words) {
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const auto equals = word.find('=');
        if (equals == std::string::npos || !options.count(word.substr(0, equals))) {
            std::fprintf(stderr, "no option %s\n", word.c_str());
            return 2;
        }
        options[word.substr(0, equals)] = std::atof(word.c_str() + equals + 1);
    }
    const bool plane = options["plane"] != 0;
    const int nodes = 13, degrees = plane ? 2 * nodes : 3, units = columns * courses;
    const int top = units * degrees, base = top + 3, all = base + 3; // both platens are rigid

    const double toPlaten = height / 2; // eq. (26) for units in series: the platens add nothing
    const auto lump = [&](double x) { return plane ? 0 : x; };
    const std::vector<Joint> kinds = {
        jointOf(3.352e11, 1.445e11, 0.1e6, 16, 0.11e6, 160, 0.43, 7.55e6, 15000, lump(height), false, true),
        jointOf(3.352e11, 1.445e11, 0.1e6, 16, 0.11e6, 160, 0.43, 5.93e6, 31500, lump(half), false, true),
        jointOf(3.352e12, 1.445e12, 1.5e6, 60, 3e6, 500, 0.75, 7.55e6, 15000, lump(half), false, false),
        jointOf(3.352e11, 1.445e11, 0.1e6, 16, 0.11e6, 160, 0.43, 7.55e6, 15000, lump(toPlaten), true, false)};

    // ---- mesh: nodes 0 to 8 in rows of three from bottom left, 9 to 12 at the centres of the cells
    std::array<std::array<double, 2>, 13> mesh;
    for (int n = 0; n < 9; ++n)
        mesh[n] = {(n % 3 - 1) * half / 2, (n / 3 - 1) * height / 2};
    for (int c = 0; c < 4; ++c)
        mesh[9 + c] = {(c % 2 - 0.5) * half / 2, (c / 2 - 0.5) * height / 2};
    struct Triangle {
        int n[3];
        double gx[3], gz[3], volume;
    };
    std::vector<Triangle> triangles;
    std::array<double, 13> masses{};
    for (int c = 0; c < 4; ++c) {
        const int low = c % 2 + 3 * (c / 2), ring[4] = {low, low + 1, low + 4, low + 3};
        for (int e = 0; e < 4; ++e) {
            Triangle t{{ring[e], ring[(e + 1) % 4], 9 + c}, {}, {}, 0};
            const auto &p = mesh[t.n[0]], &q = mesh[t.n[1]], &r = mesh[t.n[2]];
            const double twice = (q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1]);
            const std::array<double, 2>* at[3] = {&p, &q, &r};
            for (int i = 0; i < 3; ++i) {
                const auto &a = *at[(i + 1) % 3], &b = *at[(i + 2) % 3];
                t.gx[i] = (a[1] - b[1]) / twice;
                t.gz[i] = (b[0] - a[0]) / twice;
            }
            t.volume = 0.5 * twice * thickness;
            for (int n : t.n)
                masses[n] += density * t.volume / 3;
            triangles.push_back(t);
        }
    }
    const double shear = young / (2 * (1 + poisson)), direct = young / (1 - poisson * poisson);

    // ---- degrees of freedom
    std::vector<double> mass(all), at(all), velocity(all), force(all), before(all);
    const double unitMass = density * half * height * thickness;
    for (int u = 0; u < units; ++u)
        for (int d = 0; d < degrees; ++d)
            mass[u * degrees + d] = plane    ? masses[d / 2]
                                    : d == 2 ? unitMass * (half * half + height * height) / 12
                                             : unitMass;
    for (int d = 0; d < 6; ++d)
        mass[top + d] = platenMass;

    // ---- joints
    std::vector<Place> places;
    constexpr double share[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
    const auto sideOf = [&](int unit, double ax, double az) -> Side {
        if (unit < 0) return {unit == -1 ? base : top, ax, az};
        if (!plane) return {unit * degrees, ax, az};
        const int column = int(std::lround(2 * ax / half)) + 1, row = int(std::lround(2 * az / height)) + 1;
        return {unit * degrees + 2 * (column + 3 * row), 0, 0};
    };
    const auto join = [&](int a, int b, bool bed, int kind) {
        for (int p = 0; p < 3; ++p) {
            const double along = 0.5 * (p - 1);
            Side one = sideOf(a, bed ? along * half : half / 2, bed ? height / 2 : along * height);
            Side two = sideOf(b, bed ? along * half : -half / 2, bed ? -height / 2 : along * height);
            places.push_back({{one, two}, kind, share[p] * thickness * (bed ? half : height), bed, {}});
        }
    };
    for (int row = 0; row < courses; ++row)
        for (int column = 0; column < columns; ++column) {
            const int unit = row * columns + column;
            join(row == 0 ? -1 : unit - columns, unit, true, row == 0 ? 3 : 0);
            if (row == courses - 1) join(unit, -2, true, 3);
            if (column + 1 < columns) join(unit, unit + 1, false, (column + row) % 2 ? 1 : 2);
        }

    // ---- forces on all degrees of freedom; `law` says what a point answers to opening and slide
    const auto forces = [&](auto&& law) {
        for (auto& p : places) {
            double jump[2] = {0, 0};
            for (int s = 0; s < 2; ++s) {
                const Side& side = p.sides[s];
                double x = at[side.first], z = at[side.first + 1];
                if (!plane && side.first < top) {
                    x += at[side.first + 2] * side.az;
                    z -= at[side.first + 2] * side.ax;
                }
                jump[0] += s ? x : -x;
                jump[1] += s ? z : -z;
            }
            double normal, along;
            law(kinds[p.kind], p.state, p.bed ? jump[1] : jump[0], p.bed ? jump[0] : jump[1], normal, along);
            const double fx = p.area * (p.bed ? along : normal), fz = p.area * (p.bed ? normal : along);
            for (int s = 0; s < 2; ++s) {
                const Side& side = p.sides[s];
                const double sign = s ? -1 : 1;
                force[side.first] += sign * fx;
                force[side.first + 1] += sign * fz;
                if (!plane && side.first < top) force[side.first + 2] += sign * (fx * side.az - fz * side.ax);
            }
        }
        for (int u = 0; plane && u < units; ++u) {
            const double* x = &at[u * degrees];
            double* f = &force[u * degrees];
            for (const auto& t : triangles) {
                double ex = 0, ez = 0, turn = 0;
                for (int i = 0; i < 3; ++i) {
                    const double* d = x + 2 * t.n[i];
                    ex += t.gx[i] * d[0];
                    ez += t.gz[i] * d[1];
                    turn += t.gz[i] * d[0] + t.gx[i] * d[1];
                }
                const double sx = t.volume * direct * (ex + poisson * ez), sz = t.volume * direct * (ez + poisson * ex),
                             sxz = t.volume * shear * turn;
                for (int i = 0; i < 3; ++i) {
                    f[2 * t.n[i]] -= t.gx[i] * sx + t.gz[i] * sxz;
                    f[2 * t.n[i] + 1] -= t.gz[i] * sz + t.gx[i] * sxz;
                }
            }
        }
    };

    // ---- time step: largest frequency of the elastic wall, by iteration
    for (int d = 0; d < top; ++d)
        at[d] = std::sin(1.0 + 7.3 * d);
    double fastest = 0;
    for (int n = 0; n < 400; ++n) {
        std::fill(force.begin(), force.end(), 0);
        forces([](const Joint& j, Point&, double un, double us, double& normal, double& along) {
            normal = j.kn * un;
            along = j.ks * us;
        });
        double size = 0;
        for (int d = 0; d < top; ++d) {
            force[d] /= -mass[d];
            size += force[d] * force[d];
        }
        fastest = std::sqrt(size);
        for (int d = 0; d < all; ++d)
            at[d] = d < top ? force[d] / fastest : 0;
    }
    std::fill(at.begin(), at.end(), 0);
    const double dt = options["fraction"] * 2 / std::sqrt(1.02 * fastest * (1 + options["damping"]));

    double load = 0, speed = 0, damping = 0.8, pull = 0;
    const auto step = [&] {
        std::fill(force.begin(), force.end(), 0);
        for (int d = 1; d < top; d += plane ? 2 : 3)
            force[d] = -mass[d] * gravity;
        force[top + 1] = -load;
        forces([](const Joint& j, Point& p, double un, double us, double& normal, double& along) {
            advance(j, p, un, us);
            normal = p.sigma;
            along = p.tau;
        });
        const auto sign = [](double x) { return (x > 0) - (x < 0); };
        for (int d = 0; d < top + 2; ++d) {
            const double f = force[d] + 0.5 * damping * std::abs(force[d]) *
                                            (sign(force[d] - before[d]) - sign(velocity[d])); // combined damping
            before[d] = force[d];
            velocity[d] += f / mass[d] * dt;
        }
        pull = -force[top];
        velocity[top] = speed;
        for (int d = 0; d < top + 2; ++d)
            at[d] += velocity[d] * dt;
    };
    const double grow = 0.05;
    for (double time = 0; time < 3 * grow; time += dt) {
        const double x = std::min(1.0, time / grow);
        load = pressure * length * thickness * x * x * (3 - 2 * x);
        step();
    }
    damping = options["damping"];
    const double rate = options["rate"] * 1e-3, ramp = 0.02;
    const auto start = std::chrono::steady_clock::now();
    double last = -1, peak = 0, work = 0, moved = 0, lastPull = 0;
    long steps = 0;
    std::printf("displacement_mm,force_kN\n");
    for (double time = dt; moved < options["until"] * 1e-3; time += dt, ++steps) {
        speed = rate * std::min(1.0, time / ramp);
        step();
        work += 0.5 * (pull + lastPull) * (at[top] - moved);
        lastPull = pull;
        moved = at[top];
        peak = std::max(peak, pull);
        if ((moved - last) * 1e3 >= options["every"]) {
            std::printf("%.5f,%.4f\n", moved * 1e3, pull * 1e-3);
            last = moved;
        }
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::fprintf(stderr, "%ld %.6f %.4f %.3f\n", steps, seconds, peak * 1e-3, work);
}
