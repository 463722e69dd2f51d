#include "MasonryMat.hpp"

template class masonry::Adapter<masonry::MasonryMat, yade::Material>;
BOOST_CLASS_EXPORT_IMPLEMENT(masonry::MasonryMat)
