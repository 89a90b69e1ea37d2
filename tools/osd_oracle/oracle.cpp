// Limit positions, derivatives and UVs by OpenSubdiv, written for the project's golden data.
//
//   build:  g++ -O2 -std=c++17 oracle.cpp -o oracle -losdCPU         (Debian: libosd-dev, g++)
//   run:    ./oracle CAGE.obj                                        (text to stdout)
//
// The cage may hold OpenSubdiv's tags (`t crease`, `t corner`, `t hole`, `t creasemethod`,
// `t interpolateboundary`, `t facevaryinginterpolateboundary`). Every parametric quad (a quad,
// or one corner of another face) is evaluated at the 10 x 10 parameters of GRID, v fastest, by
// Far in double precision with features isolated to the deepest level, 10. Where the file has
// `vt`, they follow in each of the six modes, unless the second argument is `--no-uv`.
#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>
#include <opensubdiv/version.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

using namespace OpenSubdiv;

static const double GRID[10] = {0, .03, .125, .27, .4, .5, .61, .75, .9, 1};
static const int DEPTH = 10;
static const char *MODES[6] = {"none", "corners-only", "corners-plus1", "corners-plus2",
                               "boundaries", "all"};

struct Cage {
    std::vector<double> positions, uvs;
    std::vector<int> sizes, corners, uvCorners;
    std::vector<int> creases, sharpVertices, holes;
    std::vector<float> creaseSharpness, vertexSharpness;
    Sdc::Options::VtxBoundaryInterpolation boundary = Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER;
    bool chaikin = false;
};

[[noreturn]] static void fail(std::string const &message) {
    fprintf(stderr, "oracle: %s\n", message.c_str());
    exit(1);
}

static int fileIndex(int number, size_t count) { return number < 0 ? int(count) + number : number - 1; }

static void readFace(std::istringstream &words, Cage &cage) {
    int size = 0;
    for (std::string word; words >> word; ++size) {
        cage.corners.push_back(fileIndex(atoi(word.c_str()), cage.positions.size() / 3));
        size_t slash = word.find('/');
        if (slash != std::string::npos && slash + 1 < word.size() && word[slash + 1] != '/') {
            int number = atoi(word.c_str() + slash + 1);
            cage.uvCorners.push_back(fileIndex(number, cage.uvs.size() / 2));
        }
    }
    cage.sizes.push_back(size);
}

static void readTag(std::istringstream &words, Cage &cage) {
    std::string name, counts;
    words >> name >> counts;
    int numInts = 0, numFloats = 0, numStrings = 0;
    if (sscanf(counts.c_str(), "%d/%d/%d", &numInts, &numFloats, &numStrings) != 3) fail("bad tag " + name);
    std::vector<int> ints(numInts);
    std::vector<float> floats(numFloats);
    std::vector<std::string> strings(numStrings);
    for (int &i : ints) words >> i;
    for (float &f : floats) words >> f;
    for (std::string &s : strings) words >> s;
    if (!words) fail("short tag " + name);
    if (name == "crease") {
        // Pairs, or a chain: an odd number of vertices, or one sharpness for each of its edges.
        bool chain = numInts % 2 == 1 || (numInts > 2 && numFloats == numInts - 1);
        for (int i = 0, edge = 0; i + 1 < numInts; i += chain ? 1 : 2, ++edge) {
            cage.creases.insert(cage.creases.end(), {ints[i], ints[i + 1]});
            cage.creaseSharpness.push_back(floats.at(numFloats > 1 ? edge : 0));
        }
    } else if (name == "corner") {
        for (int i = 0; i < numInts; ++i) {
            cage.sharpVertices.push_back(ints[i]);
            cage.vertexSharpness.push_back(floats[numFloats > 1 ? i : 0]);
        }
    } else if (name == "hole") {
        cage.holes.insert(cage.holes.end(), ints.begin(), ints.end());
    } else if (name == "interpolateboundary") {
        // In the tags, 1 and 2 are the other way round than in the library.
        cage.boundary = ints.at(0) == 0   ? Sdc::Options::VTX_BOUNDARY_NONE
                        : ints.at(0) == 1 ? Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER
                                          : Sdc::Options::VTX_BOUNDARY_EDGE_ONLY;
    } else if (name == "creasemethod") {
        cage.chaikin = strings.at(0) == "chaikin";
    } else if (name == "smoothtriangles") {
        if (strings.at(0) != "catmark") fail("rules for triangles are not compared");
    } else if (name != "facevaryinginterpolateboundary") {
        fail("unknown tag " + name);
    }
}

static Cage readCage(char const *path) {
    std::ifstream in(path);
    if (!in) fail(std::string("cannot open ") + path);
    Cage cage;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string key;
        double x[3];
        words >> key;
        if (key == "v" && words >> x[0] >> x[1] >> x[2]) cage.positions.insert(cage.positions.end(), x, x + 3);
        if (key == "vt" && words >> x[0] >> x[1]) cage.uvs.insert(cage.uvs.end(), x, x + 2);
        if (key == "f") readFace(words, cage);
        if (key == "t") readTag(words, cage);
    }
    return cage;
}

static std::unique_ptr<Far::TopologyRefiner> refiner(Cage const &cage, int mode) {
    Far::TopologyDescriptor d;
    Far::TopologyDescriptor::FVarChannel channel;
    d.numVertices = int(cage.positions.size() / 3);
    d.numFaces = int(cage.sizes.size());
    d.numVertsPerFace = cage.sizes.data();
    d.vertIndicesPerFace = cage.corners.data();
    d.numCreases = int(cage.creaseSharpness.size());
    d.creaseVertexIndexPairs = cage.creases.data();
    d.creaseWeights = cage.creaseSharpness.data();
    d.numCorners = int(cage.vertexSharpness.size());
    d.cornerVertexIndices = cage.sharpVertices.data();
    d.cornerWeights = cage.vertexSharpness.data();
    d.numHoles = int(cage.holes.size());
    d.holeIndices = cage.holes.data();
    if (mode >= 0) {
        channel.numValues = int(cage.uvs.size() / 2);
        channel.valueIndices = cage.uvCorners.data();
        d.numFVarChannels = 1;
        d.fvarChannels = &channel;
    }
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(cage.boundary);
    options.SetCreasingMethod(cage.chaikin ? Sdc::Options::CREASE_CHAIKIN : Sdc::Options::CREASE_UNIFORM);
    if (mode >= 0) options.SetFVarLinearInterpolation(Sdc::Options::FVarLinearInterpolation(mode));
    typedef Far::TopologyRefinerFactory<Far::TopologyDescriptor> Factory;
    std::unique_ptr<Far::TopologyRefiner> made(Factory::Create(d, Factory::Options(Sdc::SCHEME_CATMARK, options)));
    if (!made) fail("OpenSubdiv refuses the cage");
    return made;
}

// Appends a number with 13 decimals (values are of order 1), without zeros that say nothing.
static void print(std::string &out, double x) {
    char text[64];
    snprintf(text, sizeof text, "%.13f", x);
    std::string s(text);
    s.erase(s.find_last_not_of('0') + 1);
    if (s.back() == '.') s.pop_back();
    bool negative = s[0] == '-';
    if (negative) s.erase(0, 1);
    if (s.size() > 1 && s[0] == '0') s.erase(0, 1);
    if (negative && s != "0") out += '-';
    out += s;
}

// A value of three numbers, of which texture coordinates use two.
struct Point {
    double x[3];
    void Clear(void * = nullptr) { x[0] = x[1] = x[2] = 0; }
    void AddWithWeight(Point const &p, double w) {
        for (int k = 0; k < 3; ++k) x[k] += w * p.x[k];
    }
};

// A line of the three results, of which the first `width` numbers count.
static void print(std::string &out, Point const results[3], int width) {
    for (int i = 0; i < 3 * width; ++i) {
        if (i) out += ' ';
        print(out, results[i / width].x[i % width]);
    }
    out += '\n';
}

// The surface of the positions, or of the texture coordinates.
class Limit {
public:
    Limit(Far::TopologyRefiner &mesh, bool ofTexture, std::vector<double> const &values);
    // Value and derivatives at (u, v) of a quad in Far's order, whose sides are of this length.
    void evaluate(int quad, double u, double v, double side, Point results[3]) const;
    bool has(int quad) const { return map->FindPatch(quad, .5, .5) != nullptr; }

private:
    void refine(Far::TopologyRefiner const &mesh, std::vector<double> const &values);

    bool texture;
    std::unique_ptr<Far::PatchTable> table;
    std::unique_ptr<Far::PatchMap> map;
    std::vector<Point> points;
};

Limit::Limit(Far::TopologyRefiner &mesh, bool ofTexture, std::vector<double> const &values) : texture(ofTexture) {
    int channel = 0;
    Far::PatchTableFactory::Options options(DEPTH);
    options.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
    options.useInfSharpPatch = true;
    options.SetPatchPrecision<double>();
    options.SetFVarPatchPrecision<double>();
    options.generateFVarTables = texture;
    options.generateFVarLegacyLinearPatches = false;
    options.numFVarChannels = texture ? 1 : 0;
    options.fvarChannelIndices = &channel;
    auto refinement = options.GetRefineAdaptiveOptions();
    refinement.considerFVarChannels = texture;
    mesh.RefineAdaptive(refinement);
    table.reset(Far::PatchTableFactory::Create(mesh, options));
    map.reset(new Far::PatchMap(*table));
    refine(mesh, values);
}

// Makes the control points of all patches.
void Limit::refine(Far::TopologyRefiner const &mesh, std::vector<double> const &values) {
    int width = texture ? 2 : 3;
    int refined = texture ? mesh.GetNumFVarValuesTotal(0) : mesh.GetNumVerticesTotal();
    int local = texture ? table->GetNumLocalPointsFaceVarying(0) : table->GetNumLocalPoints();
    points.resize(size_t(refined) + local);
    for (size_t i = 0; i < values.size(); ++i) points[i / width].x[i % width] = values[i];
    Far::PrimvarRefinerReal<double> interpolation(mesh);
    Point *from = points.data();
    for (int level = 1; level <= mesh.GetMaxLevel(); ++level) {
        auto const &coarse = mesh.GetLevel(level - 1);
        Point *to = from + (texture ? coarse.GetNumFVarValues(0) : coarse.GetNumVertices());
        if (texture) interpolation.InterpolateFaceVarying(level, from, to, 0);
        else interpolation.Interpolate(level, from, to);
        from = to;
    }
    if (local == 0) return;
    auto const *stencils = texture ? table->GetLocalPointFaceVaryingStencilTable<double>(0)
                                   : table->GetLocalPointStencilTable<double>();
    stencils->UpdateValues(points.data(), points.data() + refined);
}

void Limit::evaluate(int quad, double u, double v, double side, Point results[3]) const {
    double weights[3][20];
    auto const *patch = map->FindPatch(quad, u, v);
    if (texture) table->EvaluateBasisFaceVarying(*patch, u, v, weights[0], weights[1], weights[2]);
    else table->EvaluateBasis(*patch, u, v, weights[0], weights[1], weights[2]);
    Far::ConstIndexArray vertices = texture ? table->GetPatchFVarValues(*patch, 0) : table->GetPatchVertices(*patch);
    for (int d = 0; d < 3; ++d) {
        results[d].Clear();
        for (int j = 0; j < vertices.size(); ++j) {
            results[d].AddWithWeight(points[vertices[j]], (d > 0 ? side : 1) * weights[d][j]);
        }
    }
}

// All quads of the positions' surface (`mode` < 0), or of the texture coordinates.
static std::string section(Cage const &cage, int mode) {
    auto mesh = refiner(cage, mode);
    Limit limit(*mesh, mode >= 0, mode < 0 ? cage.positions : cage.uvs);
    Far::PtexIndices quads(*mesh);
    std::string out;
    for (int face = 0; face < int(cage.sizes.size()); ++face) {
        int size = cage.sizes[face], first = quads.GetFaceId(face);
        bool found = limit.has(first);
        if (!found) out += "omitted " + std::to_string(face) + '\n';
        for (int k = 0; found && k < (size == 4 ? 1 : size); ++k) {
            out += "quad " + std::to_string(face) + ' ' + std::to_string(k) + '\n';
            for (int i = 0; i < 100; ++i) {
                Point results[3];
                // Far counts the refinement that makes quads of an n-gon as one of its quads.
                limit.evaluate(first + k, GRID[i / 10], GRID[i % 10], size == 4 ? 1 : .5, results);
                print(out, results, mode < 0 ? 3 : 2);
            }
        }
    }
    return out;
}

int main(int argc, char **argv) {
    if (argc < 2) fail("usage: oracle CAGE.obj [--no-uv]");
    Cage cage = readCage(argv[1]);
    bool hasUvs = cage.uvCorners.size() == cage.corners.size() && !(argc > 2 && !strcmp(argv[2], "--no-uv"));
    const char *name = strrchr(argv[1], '/');
    printf("# Limit surface of %s by OpenSubdiv %d.%d.%d (Debian libosd-dev), written by tools/osd_oracle/oracle.cpp:\n",
           name ? name + 1 : argv[1], OPENSUBDIV_VERSION_MAJOR, OPENSUBDIV_VERSION_MINOR, OPENSUBDIV_VERSION_PATCH);
    printf("# double precision, features isolated to level %d, by Far.\n", DEPTH);
    printf("# Per quad (face, corner) and parameters (u, v), v fastest, each out of 0 .03 .125 .27 .4 .5 .61 .75 .9 1:\n");
    printf("# value, derivative along u, derivative along v.\n");
    printf("positions\n%s", section(cage, -1).c_str());
    // Many modes give the same; then the first of them is named.
    std::vector<std::string> modes;
    for (int mode = 0; hasUvs && mode < 6; ++mode) {
        modes.push_back(section(cage, mode));
        int first = int(std::find(modes.begin(), modes.end(), modes.back()) - modes.begin());
        if (first < mode) printf("uv %s as %s\n", MODES[mode], MODES[first]);
        else printf("uv %s\n%s", MODES[mode], modes.back().c_str());
    }
}
