// The plain CAD tessellation of a solid, and its dense mesh.
#include "step.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepGProp.hxx>
#include <BRepLProp_SLProps.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>
#include <gmsh.h>
#include <map>
#include <numbers>
#include <stdexcept>

namespace step_truth {
namespace {

constexpr double largest_turn = 12 * std::numbers::pi / 180;  // of the normal over one edge of the tessellation

// Joins the nodes of the faces' own triangulations: those of a CAD vertex, and those of a CAD edge, are one.
class Joined {
  public:
    Joined(const Solid& solid, Mesh& mesh) : mesh_(mesh) {
        TopExp::MapShapes(solid.shape, TopAbs_EDGE, edges_);
        TopExp::MapShapes(solid.shape, TopAbs_VERTEX, vertices_);
    }

    void add(const TopoDS_Face& face, int index) {
        TopLoc_Location location;
        const Handle(Poly_Triangulation) part = BRep_Tool::Triangulation(face, location);
        if (part.IsNull()) throw std::runtime_error("a face is not tessellated");
        std::vector<int> id(part->NbNodes() + 1, -1);
        for (TopExp_Explorer e(face.Oriented(TopAbs_FORWARD), TopAbs_EDGE); e.More(); e.Next())
            add_edge(TopoDS::Edge(e.Current()), part, location, id);
        for (int i = 1; i <= part->NbNodes(); ++i)
            if (id[i] < 0) id[i] = add_vertex(part->Node(i).Transformed(location));
        for (int i = 1; i <= part->NbTriangles(); ++i) {
            int a, b, c;
            part->Triangle(i).Get(a, b, c);
            if (id[a] == id[b] || id[b] == id[c] || id[c] == id[a]) continue;
            mesh_.triangles.push_back({id[a], id[b], id[c]});
            mesh_.face.push_back(index);
        }
    }

  private:
    int add_vertex(const gp_Pnt& p) {
        mesh_.vertices.push_back({p.X(), p.Y(), p.Z()});
        return static_cast<int>(mesh_.vertices.size()) - 1;
    }

    int at_vertex(const TopoDS_Vertex& v) {
        const auto [entry, fresh] = vertex_.try_emplace(vertices_.FindIndex(v), -1);
        if (fresh) entry->second = add_vertex(BRep_Tool::Pnt(v));
        return entry->second;
    }

    void add_edge(const TopoDS_Edge& edge, const Handle(Poly_Triangulation) & part, const TopLoc_Location& location,
                  std::vector<int>& id) {
        const Handle(Poly_PolygonOnTriangulation) line = BRep_Tool::PolygonOnTriangulation(edge, part, location);
        if (line.IsNull()) throw std::runtime_error("an edge is not tessellated");
        const int n = line->NbNodes();
        id[line->Node(1)] = at_vertex(TopExp::FirstVertex(edge));
        id[line->Node(n)] = at_vertex(TopExp::LastVertex(edge));
        std::vector<int>& inner = edge_[edges_.FindIndex(edge)];
        const bool degenerate = BRep_Tool::Degenerated(edge);
        if (inner.empty() && !degenerate)
            for (int i = 2; i < n; ++i) inner.push_back(add_vertex(part->Node(line->Node(i)).Transformed(location)));
        if (!degenerate && static_cast<int>(inner.size()) != std::max(n - 2, 0))
            throw std::runtime_error("an edge is tessellated twice");
        for (int i = 2; i < n; ++i) id[line->Node(i)] = degenerate ? id[line->Node(1)] : inner[i - 2];
    }

    Mesh& mesh_;
    TopTools_IndexedMapOfShape edges_, vertices_;
    std::map<int, int> vertex_;
    std::map<int, std::vector<int>> edge_;
};

// The largest curvature of a face, but for a few points where it may have no bound.
double curvature(const Face& face) {
    constexpr int n = 8;
    double u0, u1, v0, v1;
    BRepTools::UVBounds(face.shape, u0, u1, v0, v1);
    const BRepAdaptor_Surface surface(face.shape);
    std::vector<double> values;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            BRepLProp_SLProps at(surface, u0 + (i + 0.5) * (u1 - u0) / n, v0 + (j + 0.5) * (v1 - v0) / n, 2, 1e-9);
            if (at.IsCurvatureDefined())
                values.push_back(std::max(std::abs(at.MaxCurvature()), std::abs(at.MinCurvature())));
        }
    std::sort(values.begin(), values.end());
    return values.empty() ? 0 : values[values.size() * 9 / 10];
}

// Edge length wanted on a face: small beside its radii, and a part of its width, so that a thin face gets no slivers.
double fine_edge(const Face& face) {
    GProp_GProps boundary;
    BRepGProp::LinearProperties(face.shape, boundary);
    const double width = boundary.Mass() > 0 ? face.area / boundary.Mass() : 0, k = curvature(face);
    return k * width > largest_turn ? largest_turn / k : width;
}

double bounded(double edge, double largest) {
    return std::clamp(edge, 0.05 * largest, largest);
}

// The wanted edge length anywhere on an entity of the model: that of its faces, growing away from the edges of finer
// ones.
class Sizes {
  public:
    Sizes(const std::vector<double>& edges, double largest) : largest_(largest) {
        std::vector<double> wanted;
        for (const double e : edges) wanted.push_back(bounded(e, largest));
        gmsh::vectorpair curves;
        gmsh::model::getEntities(curves, 1);
        for (const auto& [dim, curve] : curves) add_curve(curve, wanted);
        for (std::size_t f = 0; f < wanted.size(); ++f) {
            const int tag = static_cast<int>(f) + 1;
            std::vector<int> up, down;
            gmsh::model::getAdjacencies(2, tag, up, down);
            Entity& face = entity_[{2, tag}];
            face.size = wanted[f];
            for (const int curve : down)
                for (const Sample& s : samples_[curve])
                    if (s.size < face.size) face.finer.push_back(s);
        }
        for (const auto& [dim, curve] : curves) {
            std::vector<int> up, down;
            gmsh::model::getAdjacencies(1, curve, up, down);
            for (const int face : up)
                for (const Sample& s : entity_[{2, face}].finer) entity_[{1, curve}].finer.push_back(s);
        }
    }

    double operator()(int dim, int tag, const Vec3& p) const {
        const auto at = entity_.find({dim, tag});
        if (at == entity_.end()) return largest_;
        double size = at->second.size;
        for (const Sample& s : at->second.finer) {
            const Vec3 d = p - s.point;
            const double room = size - s.size;
            if (room > 0 && growth * growth * dot(d, d) < room * room) size = s.size + growth * std::sqrt(dot(d, d));
        }
        return size;
    }

  private:
    static constexpr double growth = 0.3;
    struct Sample {
        Vec3 point;
        double size;
    };
    struct Entity {
        double size = 0;
        std::vector<Sample> finer;
    };

    void add_curve(int curve, const std::vector<double>& wanted) {
        std::vector<int> up, down;
        gmsh::model::getAdjacencies(1, curve, up, down);
        double size = largest_, length = 0;
        for (const int face : up) size = std::min(size, wanted[face - 1]);
        gmsh::model::occ::getMass(1, curve, length);
        std::vector<double> first, last, at, xyz;
        gmsh::model::getParametrizationBounds(1, curve, first, last);
        const int n = std::clamp(static_cast<int>(length / (4 * size)), 2, 40);
        if (length > 0) size = std::min(size, std::max(length, 0.05 * largest_));
        for (int i = 0; i <= n; ++i) at.push_back(first[0] + (last[0] - first[0]) * i / n);
        gmsh::model::getValue(1, curve, at, xyz);
        for (int i = 0; i <= n; ++i) samples_[curve].push_back({{xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}, size});
        entity_[{1, curve}].size = size;
    }

    double largest_;
    std::map<int, std::vector<Sample>> samples_;  // of a curve
    std::map<std::pair<int, int>, Entity> entity_;
};

void check_same_faces(const Solid& solid) {
    gmsh::vectorpair faces;
    gmsh::model::getEntities(faces, 2);
    if (faces.size() != solid.faces.size()) throw std::runtime_error("faces are shared or lost");
    for (std::size_t i = 0; i < faces.size(); ++i) {
        double area = 0;
        gmsh::model::occ::getMass(2, static_cast<int>(i) + 1, area);
        if (std::abs(area - solid.faces[i].area) > 1e-6 * area) throw std::runtime_error("faces in another order");
    }
}

void collect(Mesh& mesh, std::size_t faces) {
    std::vector<std::size_t> tags;
    std::vector<double> xyz, parameters;
    gmsh::model::mesh::getNodes(tags, xyz, parameters);
    std::map<std::size_t, int> index;
    for (std::size_t i = 0; i < tags.size(); ++i) {
        index[tags[i]] = static_cast<int>(i);
        mesh.vertices.push_back({xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]});
    }
    for (std::size_t f = 0; f < faces; ++f) {
        std::vector<std::size_t> elements, nodes;
        gmsh::model::mesh::getElementsByType(2, elements, nodes, static_cast<int>(f) + 1);
        for (std::size_t i = 0; i < nodes.size(); i += 3) {
            mesh.triangles.push_back({index[nodes[i]], index[nodes[i + 1]], index[nodes[i + 2]]});
            mesh.face.push_back(static_cast<int>(f));
        }
    }
}

}  // namespace

Mesh tessellate(const Solid& solid, double deflection) {
    Mesh mesh;
    mesh.deflection = deflection;
    BRepMesh_IncrementalMesh(solid.shape, deflection, false, largest_turn, false);
    Joined joined(solid, mesh);
    for (std::size_t i = 0; i < solid.faces.size(); ++i) joined.add(solid.faces[i].shape, static_cast<int>(i));
    return mesh;
}

std::vector<double> fine_edges(const Solid& solid) {
    std::vector<double> edges;
    for (const Face& face : solid.faces) edges.push_back(fine_edge(face));
    return edges;
}

double expected_triangles(const Solid& solid, const std::vector<double>& edges, double largest) {
    double count = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const double edge = bounded(edges[i], largest);
        count += solid.faces[i].area / (0.43 * edge * edge);
    }
    return count;
}

Mesh dense_mesh(const Solid& solid, const std::vector<double>& edges, double largest_edge) {
    Mesh mesh;
    mesh.target_edge = largest_edge;
    gmsh::initialize();
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::vectorpair entities;
    gmsh::model::occ::importShapesNativePointer(&solid.shape, entities);
    gmsh::model::occ::synchronize();
    check_same_faces(solid);
    gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
    gmsh::option::setNumber("Mesh.MeshSizeFromPoints", 0);
    gmsh::option::setNumber("Mesh.MeshSizeMax", largest_edge);
    gmsh::option::setNumber("Mesh.MeshSizeMin", 0.02 * largest_edge);
    gmsh::option::setNumber("Mesh.Algorithm", 6);
    gmsh::option::setNumber("Mesh.RandomSeed", 1);
    const Sizes sizes(edges, largest_edge);
    gmsh::model::mesh::setSizeCallback([&](int dim, int tag, double x, double y, double z) {
        return sizes(dim, tag, {x, y, z});
    });
    gmsh::model::mesh::generate(2);
    collect(mesh, solid.faces.size());
    gmsh::finalize();
    return mesh;
}

}  // namespace step_truth
