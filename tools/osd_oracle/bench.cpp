// Times of OpenSubdiv for `cargo xtask bench --peer`, written for this project.
//
//   build:  g++ -O3 -std=c++17 bench.cpp -o bench -losdCPU            (Debian: libosd-dev, g++)
//   run:    ./bench CAGE.obj SAMPLES RATE RUNS
//
// Prints a line `NAME MILLISECONDS` for each operation: one warm-up, then the median of RUNS runs
// of the CPU time of the thread.
//
//   build        arrays -> topology, adaptive refinement to level 6, patch table with Gregory
//                caps, patch map, all patch points; double precision
//   eval1        SAMPLES random places: find the patch, basis with first derivatives, sums
//   eval2        the same with second derivatives
//   tessellate   arrays -> topology, Bfr surfaces with default options, uniform tessellation of
//                every face at RATE: positions, unit normals, quads; double precision
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/bfr/tessellation.h>
#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

using namespace OpenSubdiv;

struct Cage {
    std::vector<double> positions;
    std::vector<int> sizes, corners;
};

struct Point {
    double x[3];
    void Clear(void * = nullptr) { x[0] = x[1] = x[2] = 0; }
    void AddWithWeight(Point const &p, double w) {
        for (int k = 0; k < 3; ++k) x[k] += w * p.x[k];
    }
};

struct Place {
    int face;
    double u, v;
};

static Cage readCage(char const *path) {
    Cage cage;
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        double x[3];
        if (key == "v" && words >> x[0] >> x[1] >> x[2]) cage.positions.insert(cage.positions.end(), x, x + 3);
        if (key != "f") continue;
        int size = 0;
        for (std::string word; words >> word; ++size) cage.corners.push_back(atoi(word.c_str()) - 1);
        cage.sizes.push_back(size);
    }
    return cage;
}

static std::unique_ptr<Far::TopologyRefiner> refiner(Cage const &cage) {
    Far::TopologyDescriptor d;
    d.numVertices = int(cage.positions.size() / 3);
    d.numFaces = int(cage.sizes.size());
    d.numVertsPerFace = cage.sizes.data();
    d.vertIndicesPerFace = cage.corners.data();
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    typedef Far::TopologyRefinerFactory<Far::TopologyDescriptor> Factory;
    return std::unique_ptr<Far::TopologyRefiner>(Factory::Create(d, Factory::Options(Sdc::SCHEME_CATMARK, options)));
}

// What `build` makes.
struct Patches {
    std::unique_ptr<Far::TopologyRefiner> topology;
    std::unique_ptr<Far::PatchTable> table;
    std::unique_ptr<Far::PatchMap> map;
    std::vector<Point> points;

    explicit Patches(Cage const &cage) : topology(refiner(cage)) {
        Far::PatchTableFactory::Options options(6);
        options.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
        options.useInfSharpPatch = true;
        options.SetPatchPrecision<double>();
        topology->RefineAdaptive(options.GetRefineAdaptiveOptions());
        table.reset(Far::PatchTableFactory::Create(*topology, options));
        map.reset(new Far::PatchMap(*table));
        refine(cage);
    }

    void refine(Cage const &cage) {
        int refined = topology->GetNumVerticesTotal();
        points.resize(size_t(refined) + table->GetNumLocalPoints());
        for (size_t i = 0; i < cage.positions.size(); ++i) points[i / 3].x[i % 3] = cage.positions[i];
        Far::PrimvarRefinerReal<double> interpolation(*topology);
        Point *from = points.data();
        for (int level = 1; level <= topology->GetMaxLevel(); ++level) {
            Point *to = from + topology->GetLevel(level - 1).GetNumVertices();
            interpolation.Interpolate(level, from, to);
            from = to;
        }
        if (table->GetNumLocalPoints() > 0) {
            table->GetLocalPointStencilTable<double>()->UpdateValues(points.data(), points.data() + refined);
        }
    }

    // The sum of the first coordinates of everything at all places.
    double evaluate(std::vector<Place> const &places, int order) const {
        int rows = order == 1 ? 3 : 6;
        double sum = 0, w[6][20];
        for (Place const &at : places) {
            auto const *patch = map->FindPatch(at.face, at.u, at.v);
            if (!patch) continue;
            if (order == 1) table->EvaluateBasis(*patch, at.u, at.v, w[0], w[1], w[2]);
            else table->EvaluateBasis(*patch, at.u, at.v, w[0], w[1], w[2], w[3], w[4], w[5]);
            Point result[6] = {};
            Far::ConstIndexArray vertices = table->GetPatchVertices(*patch);
            for (int i = 0; i < vertices.size(); ++i) {
                for (int row = 0; row < rows; ++row) result[row].AddWithWeight(points[vertices[i]], w[row][i]);
            }
            for (int row = 0; row < rows; ++row) sum += result[row].x[0] + result[row].x[1] + result[row].x[2];
        }
        return sum;
    }
};

static size_t tessellate(Cage const &cage, int rate) {
    auto topology = refiner(cage);
    Bfr::RefinerSurfaceFactory<> factory(*topology, Bfr::RefinerSurfaceFactory<>::Options());
    Bfr::Surface<double> surface;
    Bfr::Surface<double>::PointDescriptor stride(3);
    std::vector<double> control, at, points, normals;
    std::vector<int> facets, all;
    for (int face = 0; face < int(cage.sizes.size()); ++face) {
        if (!factory.InitVertexSurface(face, &surface)) continue;
        Bfr::Tessellation::Options options;
        options.SetFacetSize(4);
        options.PreserveQuads(true);
        Bfr::Tessellation pattern(surface.GetParameterization(), rate, options);
        at.resize(2 * size_t(pattern.GetNumCoords()));
        pattern.GetCoords(at.data());
        control.resize(3 * size_t(surface.GetNumPatchPoints()));
        surface.PreparePatchPoints(cage.positions.data(), stride, control.data(), stride);
        int first = int(points.size() / 3);
        for (size_t i = 0; i < at.size(); i += 2) {
            double p[3], a[3], b[3];
            surface.Evaluate(&at[i], control.data(), stride, p, a, b);
            double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
            double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
            for (double &x : n) x /= length;
            points.insert(points.end(), p, p + 3);
            normals.insert(normals.end(), n, n + 3);
        }
        facets.resize(4 * size_t(pattern.GetNumFacets()));
        pattern.GetFacets(facets.data());
        pattern.TransformFacetCoordIndices(facets.data(), first);
        all.insert(all.end(), facets.begin(), facets.end());
    }
    return all.size() + points.size() + normals.size();
}

static double clockMs() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

template <class Run> static void report(char const *name, int runs, Run run) {
    run();
    std::vector<double> times;
    for (int i = 0; i < runs; ++i) {
        double start = clockMs();
        run();
        times.push_back(clockMs() - start);
    }
    std::sort(times.begin(), times.end());
    printf("%s %.6f\n", name, times[times.size() / 2]);
}

int main(int argc, char **argv) {
    if (argc < 5) return 1;
    Cage cage = readCage(argv[1]);
    int rate = atoi(argv[3]), runs = atoi(argv[4]);
    uint64_t state = 88172645463325252ull;
    auto random = [&] {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        return double(state >> 32) / 4294967296.0;
    };
    std::unique_ptr<Patches> patches(new Patches(cage));
    int faces = Far::PtexIndices(*patches->topology).GetNumFaces();
    std::vector<Place> places(atoi(argv[2]));
    for (Place &at : places) {
        at.face = int(random() * faces);
        at.u = random();
        at.v = random();
    }
    volatile double sink = 0;
    report("eval1", runs, [&] { sink = patches->evaluate(places, 1); });
    report("eval2", runs, [&] { sink = patches->evaluate(places, 2); });
    report("build", runs, [&] { patches.reset(new Patches(cage)); });
    report("tessellate", runs, [&] { sink = double(tessellate(cage, rate)); });
    return sink == 0;
}
