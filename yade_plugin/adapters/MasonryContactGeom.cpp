// SPDX-License-Identifier: GPL-2.0-or-later
#include "MasonryContactGeom.hpp"

template class masonry::Adapter<masonry::MasonryContactGeom, yade::IGeom>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryContactGeom)
