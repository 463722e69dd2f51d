// SPDX-License-Identifier: GPL-2.0-or-later
// What holds for packs of numbers, whatever their width. test_common.cpp and the files test_pack_*.cpp compile this
// function, each for its own vector units: it defines MASONRY_PACK_BYTES, if not as wide as for any processor, and
// PACK_CLAIMS, the name of the function. The standard headers stand before the pragma for these units, so that their
// functions are not compiled for them.
#include "common/Pack.hpp"

// Calculates with one number and with a pack that holds it in its last place, and says where the results differ; an
// empty text says nowhere.
std::string PACK_CLAIMS(double a, double b) {
    using namespace masonry;
    double first[packed], second[packed], result[packed];
    for (int i = 0; i < packed; ++i) {
        first[i] = 1.5 + i;
        second[i] = 2.5 - i;
    }
    first[packed - 1] = a;
    second[packed - 1] = b;
    const Pack x = load(first), y = load(second);
    std::string wrong;
    const auto compare = [&](const char* what, const Pack& found, auto&& expected) {
        store(result, found);
        for (int i = 0; i < packed; ++i) {
            const double wanted = expected(first[i], second[i]);
            if (std::memcmp(&result[i], &wanted, sizeof wanted) != 0 && !(result[i] != result[i]))
                wrong += std::string(what) + " in place " + std::to_string(i) + "; ";
        }
    };
    compare("load and store", x, [](double p, double) { return p; });
    compare("sum", x + y, [](double p, double q) { return p + q; });
    compare("product", x * y, [](double p, double q) { return p * q; });
    compare("root", root(x), [](double p, double) { return root(p); });
    compare("larger", larger(x, y), [](double p, double q) { return larger(p, q); });
    compare("smaller", smaller(x, y), [](double p, double q) { return smaller(p, q); });
    compare("choose", choose(x > y, x * x, y * y), [](double p, double q) { return choose(p > q, p * p, q * q); });
    compare("all", all<Pack>(a), [a](double, double) { return all<double>(a); });
    for (int place = 0; place <= packed; ++place) { // the comparison holds in this place alone, or in none
        double values[packed + 1] = {};
        values[place] = 1;
        if (any(load(values) > all<Pack>(0.5)) != (place < packed)) wrong += "any; ";
    }
    return wrong;
}
