// SPDX-License-Identifier: GPL-2.0-or-later
// The order of what the search of the site finds: pages of modules and of changes come last, those of the manual first
// among equals. The other numbers are Sphinx's own.
var Scorer = {
    score: ([page, , , , score]) =>
        score + (/^(api|classes|CHANGELOG)/.test(page) ? -20 : /^scripts\/[A-Z]/.test(page) ? 3 : 0),
    objNameMatch: 11, objPartialMatch: 6, objPrio: { 0: 15, 1: 5, 2: -5 }, objPrioDefault: 0,
    title: 15, partialTitle: 7, term: 5, partialTerm: 2,
};
