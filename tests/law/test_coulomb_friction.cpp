// SPDX-License-Identifier: GPL-2.0-or-later
// The law of tests/law/coulomb_friction: what a law gets from the columns when it only knows one subcontact.
#include "coulomb_friction/CoulombFriction.hpp"
#include <doctest/doctest.h>
#include <map>

using namespace masonry;

TEST_CASE("a law for one subcontact gets columns: slip under constant pressure takes friction times way") {
    JointProperties p;
    p.friction = 0.5;
    p.tensileStrength = 0;
    const auto law = std::make_shared<const CoulombFriction>(p);
    const ElasticStiffness k{p.normalStiffness, p.shearStiffness};
    const auto columns = law->columns(k, 11, 2);
    const double closure = 1e-6, slide = 1e-4; // [m]
    std::vector<double> opening(11, -closure), none(11, 0), step(11, slide / 100), stress(11);
    columns->advance(1, 0, 11, opening.data(), none.data(), nullptr, stress.data());
    for (int n = 0; n < 100; ++n)
        columns->advance(1, 0, 11, none.data(), step.data(), nullptr, stress.data());
    const double strength = 0.5 * closure * k.normal; // [Pa]
    const double slip = slide - strength / k.shear;   // [m]; the rest of the slide is elastic
    CHECK(columns->state(1, 10).shearStress.a == doctest::Approx(strength).epsilon(1e-12));
    CHECK(columns->shown(1, 10, field::slip) == doctest::Approx(slip).epsilon(1e-9));
    CHECK(columns->state(1, 10).regime == Regime::Slipping);
    CHECK(columns->shown(0, 10, field::slip) == 0);
    const std::vector<double> area(2 * columns->stride(), 2.0);
    const auto sums = columns->energies(area.data(), false);
    const double work = 2 * 11 * strength * (slide - 0.5 * strength / k.shear); // [J] friction times way, and elastic
    CHECK(sums.dissipated.shear + sums.stored.shear == doctest::Approx(work).epsilon(0.02)); // of 100 steps
    CHECK(columns->shown(1, 10, field::damageTension) == 0); // what the law does not show is zero

    // The state goes by the names of its numbers, also into columns of another number of joints.
    std::map<std::string, double> numbers;
    columns->read(1, 10, [&](const char* name, double number) { numbers[name] = number; });
    CHECK(numbers.size() == 6);
    const auto lone = law->columns(k, 1, 1);
    lone->take(0, 0, *columns, 1, 10);
    CHECK(lone->shown(0, 0, field::slip) == columns->shown(1, 10, field::slip));
}
