// Constrained Delaunay triangulations of what is seen along an axis, with numbers exact.
#pragma once

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Triangulation_data_structure_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include "corpus/union/points.h"

namespace tetproof::unite {

// `Crossings`: CGAL's tag for constraints that cross.
template <class VertexInfo, class FaceInfo, class Crossings>
using PlaneTriangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Exact,
    CGAL::Triangulation_data_structure_2<
        CGAL::Triangulation_vertex_base_with_info_2<VertexInfo, Exact>,
        CGAL::Triangulation_face_base_with_info_2<
            FaceInfo, Exact, CGAL::Constrained_triangulation_face_base_2<Exact>>>,
    Crossings>;

}  // namespace tetproof::unite
