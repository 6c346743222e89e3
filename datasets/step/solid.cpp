// The solid of a STEP file: types and parameters of its faces, groups of faces on one surface, transitions.
#include "step.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepGProp_Face.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <STEPControl_Reader.hxx>
#include <ShapeCustom.hxx>
#include <ShapeCustom_Surface.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace step_truth {
namespace {

template <class Triple>
Vec3 vec(const Triple& t) {
    return {t.X(), t.Y(), t.Z()};
}

// Sets type and parameters when the surface is analytic.
bool set_analytic(Face& face, const GeomAdaptor_Surface& s) {
    switch (s.GetType()) {
        case GeomAbs_Plane:
            face.type = "plane";
            face.point = vec(s.Plane().Location());
            face.axis = vec(s.Plane().Axis().Direction());
            return true;
        case GeomAbs_Cylinder:
            face.type = "cylinder";
            face.point = vec(s.Cylinder().Location());
            face.axis = vec(s.Cylinder().Axis().Direction());
            face.radius = s.Cylinder().Radius();
            return true;
        case GeomAbs_Cone:
            face.type = "cone";
            face.point = vec(s.Cone().Apex());
            face.axis = vec(s.Cone().Axis().Direction());
            face.half_angle = std::abs(s.Cone().SemiAngle());
            return true;
        case GeomAbs_Sphere:
            face.type = "sphere";
            face.point = vec(s.Sphere().Location());
            face.radius = s.Sphere().Radius();
            return true;
        case GeomAbs_Torus:
            face.type = "torus";
            face.point = vec(s.Torus().Location());
            face.axis = vec(s.Torus().Axis().Direction());
            face.radius = s.Torus().MajorRadius();
            face.minor = s.Torus().MinorRadius();
            return true;
        default:
            return false;
    }
}

const char* free_form_name(GeomAbs_SurfaceType type) {
    switch (type) {
        case GeomAbs_BezierSurface:
            return "bezier";
        case GeomAbs_BSplineSurface:
            return "bspline";
        case GeomAbs_SurfaceOfRevolution:
            return "revolution";
        case GeomAbs_SurfaceOfExtrusion:
            return "extrusion";
        case GeomAbs_OffsetSurface:
            return "offset";
        default:
            return "other";
    }
}

struct Sample {
    Vec3 point, normal;
};

Sample sample(const TopoDS_Face& shape, double u, double v) {
    gp_Pnt p;
    gp_Vec n;
    BRepGProp_Face(shape).Normal(u, v, p, n);  // regards the orientation of the face
    if (n.Magnitude() > 0) n.Normalize();
    return {vec(p), vec(n)};
}

Sample middle(const TopoDS_Face& shape) {
    double u0, u1, v0, v1;
    BRepTools::UVBounds(shape, u0, u1, v0, v1);
    return sample(shape, 0.5 * (u0 + u1), 0.5 * (v0 + v1));
}

void scale(Vec3& v, double f) {
    for (double& x : v) x *= f;
}

// Away from the axis or centre at p.
Vec3 outwards(const Face& face, const Vec3& p) {
    Vec3 d = p - face.point;
    if (face.type == "sphere") return d;
    const double along = dot(d, face.axis);
    for (int i = 0; i < 3; ++i) d[i] -= along * face.axis[i];
    if (face.type != "torus") return d;
    const double r = std::sqrt(dot(d, d));
    Vec3 circle = face.point;
    for (int i = 0; i < 3; ++i) circle[i] += d[i] * face.radius / r;
    return p - circle;
}

void orient(Face& face) {
    const Sample m = middle(face.shape);
    if (face.type == "plane") {
        if (dot(face.axis, m.normal) < 0) scale(face.axis, -1);
        return;
    }
    if (face.type == "cone" && dot(m.point - face.point, face.axis) < 0) scale(face.axis, -1);
    face.convex = dot(outwards(face, m.point), m.normal) > 0;
}

// A free-form face that lies exactly on an analytic surface counts as that.
void recognise(Face& face, const Handle(Geom_Surface) & surface, double tolerance) {
    double u0, u1, v0, v1;
    BRepTools::UVBounds(face.shape, u0, u1, v0, v1);
    const Handle(Geom_Surface) simple = ShapeCustom_Surface(surface).ConvertToAnalytical(tolerance, false);
    if (simple.IsNull()) return;
    Face candidate = face;
    if (!set_analytic(candidate, GeomAdaptor_Surface(simple))) return;
    for (int i = 0; i <= 8; ++i)
        for (int j = 0; j <= 8; ++j)
            if (distance(candidate, sample(face.shape, u0 + i * (u1 - u0) / 8, v0 + j * (v1 - v0) / 8).point) >
                tolerance)
                return;
    candidate.native_type = face.type;
    face = candidate;
}

Face make_face(const TopoDS_Face& shape, double diagonal) {
    Face face;
    face.shape = shape;
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(shape, properties);
    face.area = properties.Mass();
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(shape);
    const GeomAdaptor_Surface adaptor(surface);
    if (!set_analytic(face, adaptor)) {
        face.type = free_form_name(adaptor.GetType());
        recognise(face, surface, 1e-7 * diagonal);
    }
    if (face.analytic()) orient(face);
    return face;
}

bool same_surface(const Face& a, const Face& b, double diagonal) {
    const double length = 1e-6 * diagonal, angle = 1e-6;
    if (!a.analytic() || a.type != b.type || a.convex != b.convex) return false;
    if (std::abs(a.radius - b.radius) > length || std::abs(a.minor - b.minor) > length) return false;
    if (std::abs(a.half_angle - b.half_angle) > angle) return false;
    const Vec3 d = b.point - a.point;
    if (a.type == "sphere") return std::sqrt(dot(d, d)) <= length;
    const Vec3 turn = cross(a.axis, b.axis);
    if (std::sqrt(dot(turn, turn)) > angle) return false;
    if (a.type == "plane") return dot(a.axis, b.axis) > 0 && std::abs(dot(d, a.axis)) <= length;
    if (a.type == "cylinder") {
        const Vec3 off = cross(d, a.axis);
        return std::sqrt(dot(off, off)) <= length;
    }
    return std::sqrt(dot(d, d)) <= length && (a.type == "torus" || dot(a.axis, b.axis) > 0);
}

int root(std::vector<int>& parent, int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

// Index of each set, numbered by first appearance.
std::vector<int> sets(std::vector<int>& parent) {
    std::vector<int> number(parent.size(), -1), set(parent.size());
    int count = 0;
    for (int i = 0; i < static_cast<int>(parent.size()); ++i) {
        int& n = number[root(parent, i)];
        if (n < 0) n = count++;
        set[i] = n;
    }
    return set;
}

struct SharedEdge {
    TopoDS_Edge edge;
    int a, b;
};

std::vector<SharedEdge> shared_edges(const Solid& solid) {
    TopTools_IndexedDataMapOfShapeListOfShape faces_of_edge;
    TopExp::MapShapesAndAncestors(solid.shape, TopAbs_EDGE, TopAbs_FACE, faces_of_edge);
    std::vector<SharedEdge> result;
    const auto index = [&](const TopoDS_Shape& shape) {
        for (int i = 0; i < static_cast<int>(solid.faces.size()); ++i)
            if (solid.faces[i].shape.IsSame(shape)) return i;
        throw std::runtime_error("edge without face");
    };
    for (int i = 1; i <= faces_of_edge.Extent(); ++i) {
        const TopoDS_Edge edge = TopoDS::Edge(faces_of_edge.FindKey(i));
        if (BRep_Tool::Degenerated(edge) || faces_of_edge(i).Extent() != 2) continue;
        const int a = index(faces_of_edge(i).First()), b = index(faces_of_edge(i).Last());
        if (a != b) result.push_back({edge, a, b});
    }
    return result;
}

void group_faces(Solid& solid, const std::vector<SharedEdge>& edges) {
    const int n = static_cast<int>(solid.faces.size());
    std::vector<int> parent(n);
    std::iota(parent.begin(), parent.end(), 0);
    for (const SharedEdge& e : edges)
        if (same_surface(solid.faces[e.a], solid.faces[e.b], solid.diagonal))
            parent[std::max(root(parent, e.a), root(parent, e.b))] = std::min(root(parent, e.a), root(parent, e.b));
    const std::vector<int> group = sets(parent);
    for (int i = 0; i < n; ++i) solid.faces[i].group = group[i];
    solid.groups = 1 + *std::max_element(group.begin(), group.end());
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < i; ++j)
            if (root(parent, i) != root(parent, j) && same_surface(solid.faces[i], solid.faces[j], solid.diagonal))
                parent[root(parent, i)] = root(parent, j);
    solid.surface_of_group.resize(solid.groups);
    const std::vector<int> surface = sets(parent);
    for (int i = 0; i < n; ++i) solid.surface_of_group[group[i]] = surface[i];
}

double mean_angle(const SharedEdge& e, const Solid& solid) {
    double f, l, sum = 0;
    const TopoDS_Face &a = solid.faces[e.a].shape, &b = solid.faces[e.b].shape;
    const Handle(Geom2d_Curve) ca = BRep_Tool::CurveOnSurface(e.edge, a, f, l);
    const Handle(Geom2d_Curve) cb = BRep_Tool::CurveOnSurface(e.edge, b, f, l);
    if (ca.IsNull() || cb.IsNull()) return 0;
    constexpr int samples = 16;
    for (int i = 0; i < samples; ++i) {
        const double t = f + (l - f) * (i + 0.5) / samples;
        const gp_Pnt2d pa = ca->Value(t), pb = cb->Value(t);
        const double c = dot(sample(a, pa.X(), pa.Y()).normal, sample(b, pb.X(), pb.Y()).normal);
        sum += std::acos(std::clamp(c, -1.0, 1.0));
    }
    return sum / samples * 180 / std::numbers::pi;
}

void find_adjacency(Solid& solid, const std::vector<SharedEdge>& edges) {
    std::map<std::pair<int, int>, Adjacency> found;
    for (const SharedEdge& e : edges) {
        const auto [a, b] = std::minmax(solid.faces[e.a].group, solid.faces[e.b].group);
        if (a == b) continue;
        const double length = GCPnts_AbscissaPoint::Length(BRepAdaptor_Curve(e.edge));
        Adjacency& adjacency = found.try_emplace({a, b}, Adjacency{a, b, 0, 0}).first->second;
        adjacency.length += length;
        adjacency.angle += length * mean_angle(e, solid);
    }
    for (auto& [pair, adjacency] : found) {
        if (adjacency.length > 0) adjacency.angle /= adjacency.length;
        solid.adjacency.push_back(adjacency);
    }
}

}  // namespace

double distance(const Face& face, const Vec3& p) {
    const Vec3 d = p - face.point;
    const double along = dot(d, face.axis), length = std::sqrt(dot(d, d));
    if (face.type == "plane") return std::abs(along);
    if (face.type == "sphere") return std::abs(length - face.radius);
    const Vec3 off = cross(d, face.axis);
    const double r = std::sqrt(dot(off, off));
    if (face.type == "cylinder") return std::abs(r - face.radius);
    if (face.type == "cone") return std::abs(r * std::cos(face.half_angle) - along * std::sin(face.half_angle));
    // The part of a self-crossing torus beyond its axis has the tube's centre on the other side.
    return std::min(std::abs(std::hypot(r - face.radius, along) - face.minor),
                    std::abs(std::hypot(r + face.radius, along) - face.minor));
}

Solid read_solid(const std::string& step_file) {
    STEPControl_Reader reader;
    if (reader.ReadFile(step_file.c_str()) != IFSelect_RetDone) throw std::runtime_error("cannot be read");
    reader.TransferRoots();
    const TopoDS_Shape all = reader.OneShape();
    if (all.IsNull()) throw std::runtime_error("no shape");
    TopExp_Explorer solids(all, TopAbs_SOLID);
    if (!solids.More()) throw std::runtime_error("no solid");
    Solid solid;
    solid.shape = ShapeCustom::SweptToElementary(solids.Current());
    solids.Next();
    if (solids.More()) throw std::runtime_error("more than one solid");
    Bnd_Box box;
    BRepBndLib::AddOptimal(solid.shape, box, false, false);
    solid.diagonal = std::sqrt(box.SquareExtent());
    for (TopExp_Explorer e(solid.shape, TopAbs_FACE); e.More(); e.Next())
        solid.faces.push_back(make_face(TopoDS::Face(e.Current()), solid.diagonal));
    const std::vector<SharedEdge> edges = shared_edges(solid);
    group_faces(solid, edges);
    find_adjacency(solid, edges);
    return solid;
}

}  // namespace step_truth
