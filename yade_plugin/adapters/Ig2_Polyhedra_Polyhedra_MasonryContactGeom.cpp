// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ig2_Polyhedra_Polyhedra_MasonryContactGeom.hpp"

template class masonry::Adapter<masonry::Ig2_Polyhedra_Polyhedra_MasonryContactGeom,
                                masonry::Ig2_MasonryBlock_MasonryBlock_MasonryContactGeom>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::Ig2_Polyhedra_Polyhedra_MasonryContactGeom)
