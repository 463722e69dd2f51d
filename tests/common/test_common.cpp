// SPDX-License-Identifier: GPL-2.0-or-later
// Text, descriptions of properties, packs of numbers and vectorised loops.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "common/Pack.hpp"
#include "common/Property.hpp"
#include "common/Text.hpp"
#include "common/Vectorised.hpp"
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace masonry;

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double notANumber = std::numeric_limits<double>::quiet_NaN();
} // namespace

// ---- text -----------------------------------------------------------------------------------------------------------

TEST_CASE("numbers are written with six digits, as short as they can be") {
    CHECK(text(0.1) == "0.1");
    CHECK(text(12) == "12");
    CHECK(text(1 / 3.0) == "0.333333");
    CHECK(text(123456789) == "1.23457e+08");
    CHECK(text(-5e-7) == "-5e-07");
    CHECK(text(infinity) == "inf");
}

TEST_CASE("parts are joined with separators between them only") {
    CHECK(joined({}) == "");
    CHECK(joined({"a"}, ", ") == "a");
    CHECK(joined({"a", "b", "c"}, ", ") == "a, b, c");
    CHECK(joined({"a", "b"}) == "a\n  b");
}

TEST_CASE("a long list shows its first ten lines and says how many more there are") {
    const auto list = [](int count) {
        std::vector<std::string> parts;
        for (int i = 1; i <= count; ++i)
            parts.push_back("line " + std::to_string(i));
        return parts;
    };
    CHECK(firstOf(list(0)) == "");
    CHECK(firstOf(list(10)) == joined(list(10), "\n"));
    CHECK(firstOf(list(11)) == joined(list(10), "\n") + "\nand 1 more");
    CHECK(firstOf(list(1234)) == joined(list(10), "\n") + "\nand 1224 more");
    CHECK(firstOf(list(5), 2) == "line 1\nline 2\nand 3 more");
}

// ---- properties -----------------------------------------------------------------------------------------------------

TEST_CASE("bounds are said in words") {
    const auto p = number("Pa", "strength");
    CHECK(p.bounds() == "");
    CHECK(p.above(0).bounds() == "above 0");
    CHECK(p.atLeast(0).bounds() == "at least 0");
    CHECK(p.below(1).bounds() == "below 1");
    CHECK(p.atMost(1).bounds() == "at most 1");
    CHECK(p.atLeast(0).atMost(0.99).bounds() == "0 to 0.99");
    CHECK(p.above(0).atMost(1).bounds() == "above 0 and at most 1");
    CHECK(p.atLeast(0).below(1).bounds() == "at least 0 and below 1");
    CHECK(p.above(-1).below(1).bounds() == "above -1 and below 1");
}

TEST_CASE("the documentation of a property is one sentence with unit, bounds and source") {
    const auto modulus = number("Pa", "Young's modulus of the unit").above(0).source("paper table 2");
    CHECK(modulus.documentation() == "Young's modulus of the unit [Pa], above 0 (paper table 2).");
    CHECK(number("-", "friction").documentation() == "friction [-].");
    CHECK(described("name of the joint").documentation() == "name of the joint.");
    CHECK(number("Pa", "").isNumber());
    CHECK(!described("").isNumber());
}

TEST_CASE("a bound that is set leaves the description from which it was made as it was") {
    constexpr auto plain = number("mm", "opening");
    constexpr auto bounded = plain.above(0).atMost(2).usually(1e-3, 5, "m").source("paper");
    CHECK(plain.bounds() == "");
    CHECK(std::string(plain.from) == "");
    CHECK(plain.usualHigh == infinity);
    CHECK(bounded.usualLow == 1e-3);
    CHECK(bounded.usualHigh == 5);
    CHECK(std::string(bounded.otherUnit) == "m");
    CHECK(std::string(bounded.unit) == "mm");
}

TEST_CASE("a problem names the property, the value with its unit, and the bound") {
    const auto damping = number("-", "").atLeast(0).atMost(0.99);
    CHECK(damping.problem("damping", 1) == "damping 1 must be 0 to 0.99");
    CHECK(damping.problem("damping", notANumber) == "damping nan must be a finite number, 0 to 0.99");
    const auto strength = number("Pa", "").above(0);
    CHECK(strength.problem("tensile strength", -5) == "tensile strength -5 Pa must be above 0");
    CHECK(strength.problem("tensile strength", infinity) == "tensile strength inf Pa must be a finite number above 0");
    CHECK(number("Pa", "").problem("stress", -infinity) == "stress -inf Pa must be a finite number");
}

TEST_CASE("a value is a problem exactly if it is not finite or lies beyond a bound, and at it if that is excluded") {
    std::mt19937 dice(2);
    std::uniform_int_distribution<int> bound(-3, 3), kind(0, 2);
    for (int n = 0; n < 2000; ++n) {
        auto p = number("m", "");
        const double low = bound(dice), high = low + std::abs(bound(dice));
        const int lowKind = kind(dice), highKind = kind(dice); // none, included, excluded
        if (lowKind) p = lowKind == 1 ? p.atLeast(low) : p.above(low);
        if (highKind) p = highKind == 1 ? p.atMost(high) : p.below(high);
        for (double value = -7; value <= 7; value += 0.5) {
            const bool lowKept = lowKind == 0 || (lowKind == 1 ? value >= low : value > low);
            const bool highKept = highKind == 0 || (highKind == 1 ? value <= high : value < high);
            CHECK(p.problem("x", value).empty() == (lowKept && highKept));
        }
        for (double value : {notANumber, infinity, -infinity})
            CHECK(!p.problem("x", value).empty());
    }
}

TEST_CASE("names of the code become words") {
    CHECK(inWords("tensileStrength") == "tensile strength");
    CHECK(inWords("modeIFractureEnergy") == "mode I fracture energy");
    CHECK(inWords("modeIIFractureEnergy") == "mode II fracture energy");
    CHECK(inWords("friction") == "friction");
    CHECK(inWords("") == "");
}

TEST_CASE("a misspelt name is answered with the nearest one, unless more than a third of its letters are wrong") {
    const std::vector<std::string> names = {"tensileStrength", "cohesion", "friction", "residualFriction"};
    CHECK(nearestName("Friction", names) == "friction"); // capitals do not count
    CHECK(nearestName("COHESION", names) == "cohesion");
    CHECK(nearestName("fricton", names) == "friction");               // a letter is missing
    CHECK(nearestName("cohesionn", names) == "cohesion");             // one too many
    CHECK(nearestName("tensilStrenght", names) == "tensileStrength"); // one missing, two exchanged
    CHECK(nearestName("residualfriktion", names) == "residualFriction");
    CHECK(nearestName("weight", names) == "");
    CHECK(nearestName("", names) == "");
    CHECK(nearestName("friction", {}) == "");
    // Of short names two letters may differ, and not three; of nine letters three, and not four.
    CHECK(nearestName("abc", {"xyc"}) == "xyc");
    CHECK(nearestName("abc", {"xyz"}) == "");
    CHECK(nearestName("abcdefghi", {"xyzdefghi"}) == "xyzdefghi");
    CHECK(nearestName("abcdefghi", {"wxyzefghi"}) == "");
}

TEST_CASE("a name with up to two wrong letters is found again, whatever letters they are") {
    const std::vector<std::string> names = {"normalStiffness", "shearStiffness", "cohesion", "dilatancy"};
    std::mt19937 dice(3);
    for (int n = 0; n < 2000; ++n) {
        const auto& right = names[dice() % names.size()];
        auto wrong = right;
        for (int edit = 0; edit < 2; ++edit) {
            const std::size_t at = dice() % wrong.size();
            const char letter = char('a' + dice() % 26);
            if (dice() % 3 == 0)
                wrong.erase(at, 1);
            else if (dice() % 2 == 0)
                wrong.insert(at, 1, letter);
            else
                wrong[at] = letter;
        }
        CHECK(nearestName(wrong, names) == right);
    }
}

// ---- packs of numbers -----------------------------------------------------------------------------------------------

#define PACK_CLAIMS differencesAny // packs of two numbers, for any processor
#include "pack_claims.hpp"
std::string differencesAvx2(double a, double b);
std::string differencesAvx512(double a, double b);

TEST_CASE("the larger and the smaller of two numbers, of which the second is taken where one is NaN") {
    CHECK(larger(1.0, 2.0) == 2);
    CHECK(larger(2.0, 1.0) == 2);
    CHECK(smaller(1.0, 2.0) == 1);
    CHECK(smaller(2.0, 1.0) == 1);
    CHECK(larger(notANumber, 1.0) == 1);
    CHECK(smaller(notANumber, 1.0) == 1);
    CHECK(std::isnan(larger(1.0, notANumber)));
    CHECK(choose(true, 1.0, 2.0) == 1);
    CHECK(choose(false, 1.0, 2.0) == 2);
    CHECK(root(9.0) == 3);
    CHECK(all<double>(0.1) == 0.1);
}

TEST_CASE("the number that is picked has its own bits, whatever the other is") {
    const double odd[] = {0.0, -0.0, 1.0, infinity, -infinity, 5e-324, 1e308, notANumber};
    for (double a : odd)
        for (double b : odd) {
            const double first = pick(1, a, b), second = pick(0, a, b);
            CHECK(std::memcmp(&first, &a, sizeof a) == 0);
            CHECK(std::memcmp(&second, &b, sizeof b) == 0);
        }
}

namespace {

void checkPacks(std::string (*differences)(double, double)) {
    const std::vector<double> odd = {0.0, -0.0, 1.0, infinity, -infinity, 5e-324, 1e-308, 1e308, notANumber};
    for (double a : odd)
        for (double b : odd)
            CHECK(differences(a, b) == "");
    std::mt19937_64 dice(4);
    for (int n = 0; n < 20000; ++n) {
        double a, b;
        const std::uint64_t bits[2] = {dice(), dice()}; // all exponents
        std::memcpy(&a, &bits[0], sizeof a);
        std::memcpy(&b, &bits[1], sizeof b);
        const auto wrong = differences(a, b);
        if (!wrong.empty()) FAIL_CHECK(wrong << "of " << a << " and " << b);
    }
}

} // namespace

TEST_CASE("a pack of two, four or eight numbers gives the bits of each number alone, where there are such units") {
    checkPacks(differencesAny);
#if MASONRY_VECTOR_UNITS
    if (__builtin_cpu_supports("avx2")) checkPacks(differencesAvx2);
    if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq")) checkPacks(differencesAvx512);
#endif
}

// ---- vectorised loops -----------------------------------------------------------------------------------------------

namespace {

MASONRY_VECTORISED void productsLess(int n, const double* a, const double* b, const double* c,
                                     double* __restrict result) {
    MASONRY_INDEPENDENT
    for (int i = 0; i < n; ++i)
        result[i] = a[i] * b[i] - c[i];
}

} // namespace

TEST_CASE("a vectorised loop rounds the product before it takes the difference, on every processor") {
    // Contracted to one instruction, a b - c would keep the rounding error of the product.
    std::mt19937 dice(5);
    std::uniform_real_distribution<> unit(0, 1);
    const int n = 1003; // no multiple of any width
    std::vector<double> a(n), b(n), c(n), result(n);
    for (int i = 0; i < n; ++i) {
        a[i] = unit(dice);
        b[i] = unit(dice);
        volatile double product = a[i] * b[i];
        c[i] = product;
    }
    productsLess(n, a.data(), b.data(), c.data(), result.data());
    for (double difference : result)
        CHECK(difference == 0);
}

TEST_CASE("a row is one line of the cache, with eight numbers from its first byte on") {
    CHECK(sizeof(Row) == 64);
    CHECK(alignof(Row) == 64);
    CHECK(lanes == 8);
    const std::vector<Row> rows(3);
    for (const auto& row : rows)
        CHECK(reinterpret_cast<std::uintptr_t>(&row) % 64 == 0);
}
