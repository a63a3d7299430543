// Embree 3 on the meshes and rays that Lesk's example `rays` writes, one thread.
// usage: embree_rays FOLDER; prints one line per mesh, kind and query: "MESH KIND QUERY MEDIAN BEST", Mrays/s,
// then "MESH KIND disagree COUNT": rays whose distance differs from Lesk's by more than 1e-3 (1 + t).
#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

using std::string;
using std::vector;

// seconds that this process has run: other programs may want the core
static double now() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

template <class T>
static vector<T> read(FILE* file, size_t count) {
    vector<T> out(count);
    if (fread(out.data(), sizeof(T), count, file) != count) {
        fprintf(stderr, "error: a file is too short\n");
        exit(2);
    }
    return out;
}

static FILE* open(const string& path) {
    FILE* file = fopen(path.c_str(), "rb");
    if (!file) {
        fprintf(stderr, "error: %s cannot be read\n", path.c_str());
        exit(2);
    }
    return file;
}

static RTCScene load(RTCDevice device, const string& path) {
    FILE* file = open(path);
    auto head = read<unsigned>(file, 2);
    auto positions = read<float>(file, 3 * size_t(head[0]));
    auto indices = read<unsigned>(file, 3 * size_t(head[1]));
    fclose(file);
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* p = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, head[0]);
    std::copy(positions.begin(), positions.end(), static_cast<float*>(p));
    void* i = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, head[1]);
    std::copy(indices.begin(), indices.end(), static_cast<unsigned*>(i));
    rtcCommitGeometry(mesh);
    RTCScene scene = rtcNewScene(device);
    rtcAttachGeometry(scene, mesh);
    double start = now();
    rtcCommitScene(scene);
    printf("%zu triangles built %.3f s\n", size_t(head[1]), now() - start);
    return scene;
}

static RTCRayHit ray(const float* r) {
    RTCRayHit out{};
    out.ray.org_x = r[0], out.ray.org_y = r[1], out.ray.org_z = r[2];
    out.ray.dir_x = r[3], out.ray.dir_y = r[4], out.ray.dir_z = r[5];
    out.ray.tfar = INFINITY, out.ray.mask = unsigned(-1);
    out.hit.geomID = out.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return out;
}

// sixteen rays as a packet
static RTCRayHit16 packet(const float* rays) {
    RTCRayHit16 out{};
    for (int k = 0; k < 16; k++, rays += 6) {
        out.ray.org_x[k] = rays[0], out.ray.org_y[k] = rays[1], out.ray.org_z[k] = rays[2];
        out.ray.dir_x[k] = rays[3], out.ray.dir_y[k] = rays[4], out.ray.dir_z[k] = rays[5];
        out.ray.tfar[k] = INFINITY, out.ray.mask[k] = unsigned(-1);
        out.hit.geomID[k] = out.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    return out;
}

template <class F>
static void rate(const string& what, size_t n, F run) {
    vector<double> seconds;
    for (int k = 0; k < 7; k++) {
        double start = now();
        run();
        seconds.push_back(now() - start);
    }
    std::sort(seconds.begin(), seconds.end());
    printf("%s %.3f %.3f\n", what.c_str(), n / seconds[3] * 1e-6, n / seconds[0] * 1e-6);
}

int main(int count, char** arguments) {
    if (count != 2) return 2;
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    const string folder = string(arguments[1]) + "/";
    RTCDevice device = rtcNewDevice("threads=1");
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (const char* mesh : {"70k", "1M"}) {
        RTCScene scene = load(device, folder + "mesh_" + mesh + ".bin");
        for (const char* kind : {"primary", "bounce"}) {
            const string name = string(mesh) + " " + kind;
            const string suffix = string(mesh) + "_" + kind + ".bin";
            FILE* file = open(folder + "rays_" + suffix);
            const size_t n = read<unsigned>(file, 1)[0];
            const auto rays = read<float>(file, 6 * n);
            fclose(file);
            file = open(folder + "t_" + suffix);
            const auto expected = read<float>(file, n);
            fclose(file);
            vector<float> t(n);
            rate(name + " nearest", n, [&] {
                for (size_t i = 0; i < n; i++) {
                    RTCRayHit hit = ray(&rays[6 * i]);
                    rtcIntersect1(scene, &context, &hit);
                    t[i] = hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? INFINITY : hit.ray.tfar;
                }
            });
            size_t disagree = 0;
            for (size_t i = 0; i < n; i++) {
                const bool both = std::isfinite(t[i]) && std::isfinite(expected[i]);
                if (std::isfinite(t[i]) != std::isfinite(expected[i])) disagree++;
                if (both && std::fabs(t[i] - expected[i]) > 1e-3f * (1 + t[i])) disagree++;
            }
            rate(name + " any", n, [&] {
                for (size_t i = 0; i < n; i++) {
                    RTCRayHit hit = ray(&rays[6 * i]);
                    rtcOccluded1(scene, &context, &hit.ray);
                    t[i] = hit.ray.tfar;
                }
            });
            alignas(64) const int all[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
            const size_t whole = n / 16 * 16;
            rate(name + " nearest16", whole, [&] {
                for (size_t i = 0; i < whole; i += 16) {
                    RTCRayHit16 hit = packet(&rays[6 * i]);
                    rtcIntersect16(all, scene, &context, &hit);
                    for (size_t k = 0; k < 16; k++) t[i + k] = hit.ray.tfar[k];
                }
            });
            rate(name + " any16", whole, [&] {
                for (size_t i = 0; i < whole; i += 16) {
                    RTCRayHit16 hit = packet(&rays[6 * i]);
                    rtcOccluded16(all, scene, &context, &hit.ray);
                    for (size_t k = 0; k < 16; k++) t[i + k] = hit.ray.tfar[k];
                }
            });
            printf("%s disagree %zu\n", name.c_str(), disagree);
        }
        rtcReleaseScene(scene);
    }
    rtcReleaseDevice(device);
}
