// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryContactPhys.hpp"

template class masonry::Adapter<masonry::MasonryContactPhys, yade::IPhys>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryContactPhys)
