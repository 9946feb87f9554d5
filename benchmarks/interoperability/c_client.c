/* A client in C on libiec61850's own interface: what interoperability and pull speed are measured with.
 *
 *   c_client pull HOST PORT FILE TIMES      fetches the file; a line "BYTES SECONDS" each time
 *   c_client operate HOST PORT LD/LN.DO 0|1 by the control model found; "operated"
 *   c_client reports HOST PORT RCB SECONDS  enables the block, asks for all values; "report MEMBERS" for each
 *
 *
 * With CERTIFICATE KEY AUTHORITY PINNED after these, four files, it does so over TLS.
 *
 * The few declarations it needs are its own, so that it links against the shared library alone.
 */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

typedef void* Handle;
typedef bool (*FilePart)(void*, uint8_t*, uint32_t);
typedef void (*ReportArrived)(void*, Handle);

extern Handle IedConnection_createEx(Handle, bool);
extern void IedConnection_destroy(Handle);
extern void IedConnection_connect(Handle, int*, const char*, int);
extern Handle IedConnection_getLogicalDeviceList(Handle, int*);
extern uint32_t IedConnection_getFile(Handle, int*, const char*, FilePart, void*);
extern Handle IedConnection_getRCBValues(Handle, int*, const char*, Handle);
extern void IedConnection_setRCBValues(Handle, int*, Handle, uint32_t, bool);
extern void IedConnection_installReportHandler(Handle, const char*, const char*, ReportArrived, void*);
extern const char* ClientReportControlBlock_getRptId(Handle);
extern void ClientReportControlBlock_setRptEna(Handle, bool);
extern void ClientReportControlBlock_setGI(Handle, bool);
extern Handle ClientReport_getDataSetValues(Handle);
extern uint32_t MmsValue_getArraySize(Handle);
extern Handle MmsValue_newBoolean(bool);
extern void MmsValue_delete(Handle);
extern Handle ControlObjectClient_create(const char*, Handle);
extern void ControlObjectClient_destroy(Handle);
extern int ControlObjectClient_getControlModel(Handle);
extern bool ControlObjectClient_select(Handle);
extern bool ControlObjectClient_selectWithValue(Handle, Handle);
extern bool ControlObjectClient_operate(Handle, Handle, uint64_t);
extern void LinkedList_destroy(Handle);

/* Weak, because a library may have been built without TLS. */
#define IF_THERE __attribute__((weak))
extern Handle TLSConfiguration_create(void) IF_THERE;
extern void TLSConfiguration_setAllowOnlyKnownCertificates(Handle, bool) IF_THERE;
extern bool TLSConfiguration_setOwnCertificateFromFile(Handle, const char*) IF_THERE;
extern bool TLSConfiguration_setOwnKeyFromFile(Handle, const char*, const char*) IF_THERE;
extern bool TLSConfiguration_addCACertificateFromFile(Handle, const char*) IF_THERE;
extern bool TLSConfiguration_addAllowedCertificateFromFile(Handle, const char*) IF_THERE;
extern void TLSConfiguration_destroy(Handle) IF_THERE;

enum { SBO_NORMAL = 2, SBO_ENHANCED = 4 };
enum { RPT_ENA = 2, GI = 1024, CONNECTION_LOST = 3, ATTEMPTS = 5 };

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double) now.tv_sec + 1e-9 * (double) now.tv_nsec;
}

static int fail(const char* what, int error)
{
    fprintf(stderr, "%s: error %d\n", what, error);
    return 1;
}

/* The library may report success and lose the association at the first request: ask something first. */
static Handle connected(const char* host, int port, Handle tls, int* error)
{
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        Handle connection = IedConnection_createEx(tls, true);
        IedConnection_connect(connection, error, host, port);
        if (*error == 0) {
            Handle names = IedConnection_getLogicalDeviceList(connection, error);
            if (names)
                LinkedList_destroy(names);
        }
        if (*error == 0)
            return connection;
        IedConnection_destroy(connection);
        if (*error != CONNECTION_LOST)
            break;
    }
    return NULL;
}

static Handle tls_with(char** files)
{
    Handle tls = TLSConfiguration_create ? TLSConfiguration_create() : NULL;
    if (tls == NULL)
        return NULL;
    TLSConfiguration_setAllowOnlyKnownCertificates(tls, true);
    if (TLSConfiguration_setOwnCertificateFromFile(tls, files[0])
        && TLSConfiguration_setOwnKeyFromFile(tls, files[1], NULL)
        && TLSConfiguration_addCACertificateFromFile(tls, files[2])
        && TLSConfiguration_addAllowedCertificateFromFile(tls, files[3]))
        return tls;
    TLSConfiguration_destroy(tls);
    return NULL;
}

static bool count(void* total, uint8_t* part, uint32_t size)
{
    (void) part;
    *(uint64_t*) total += size;
    return true;
}

static int pull(Handle connection, const char* file, int times)
{
    for (int done = 0; done < times; done++) {
        int error = 0;
        uint64_t received = 0;
        double begun_s = now_s();
        IedConnection_getFile(connection, &error, file, count, &received);
        if (error != 0)
            return fail("fetch", error);
        printf("%llu %.6f\n", (unsigned long long) received, now_s() - begun_s);
        fflush(stdout);
    }
    return 0;
}

static int operate(Handle connection, const char* reference, bool state)
{
    Handle control = ControlObjectClient_create(reference, connection);
    if (control == NULL)
        return fail("no such control", 0);
    Handle value = MmsValue_newBoolean(state);
    int model = ControlObjectClient_getControlModel(control);
    bool done = true;
    if (model == SBO_NORMAL)
        done = ControlObjectClient_select(control);
    else if (model == SBO_ENHANCED)
        done = ControlObjectClient_selectWithValue(control, value);
    done = done && ControlObjectClient_operate(control, value, 0);
    MmsValue_delete(value);
    ControlObjectClient_destroy(control);
    if (!done)
        return fail("refused", model);
    printf("operated\n");
    return 0;
}

static void arrived(void* parameter, Handle report)
{
    (void) parameter;
    printf("report %u\n", (unsigned) MmsValue_getArraySize(ClientReport_getDataSetValues(report)));
    fflush(stdout);
}

static int reports(Handle connection, const char* reference, double seconds)
{
    int error = 0;
    Handle block = IedConnection_getRCBValues(connection, &error, reference, NULL);
    if (error != 0)
        return fail("read the block", error);
    IedConnection_installReportHandler(
        connection, reference, ClientReportControlBlock_getRptId(block), arrived, NULL);
    ClientReportControlBlock_setRptEna(block, true);
    IedConnection_setRCBValues(connection, &error, block, RPT_ENA, true);
    if (error != 0)
        return fail("enable the block", error);
    ClientReportControlBlock_setGI(block, true);
    IedConnection_setRCBValues(connection, &error, block, GI, true);
    if (error != 0)
        return fail("general interrogation", error);
    usleep((useconds_t) (seconds * 1e6));
    ClientReportControlBlock_setRptEna(block, false);
    IedConnection_setRCBValues(connection, &error, block, RPT_ENA, true);
    return error == 0 ? 0 : fail("disable the block", error);
}

int main(int argc, char** argv)
{
    if (argc != 6 && argc != 10) {
        fprintf(stderr, "c_client pull|operate|reports HOST PORT OBJECT NUMBER [CERTIFICATE KEY AUTHORITY PINNED]\n");
        return 2;
    }
    Handle tls = argc == 10 ? tls_with(argv + 6) : NULL;
    if (argc == 10 && tls == NULL)
        return fail("TLS with these files", 0);
    int error = 0;
    Handle connection = connected(argv[2], atoi(argv[3]), tls, &error);
    if (connection == NULL)
        return fail("connect", error);
    int result = 2;
    if (strcmp(argv[1], "pull") == 0)
        result = pull(connection, argv[4], atoi(argv[5]));
    else if (strcmp(argv[1], "operate") == 0)
        result = operate(connection, argv[4], atoi(argv[5]) != 0);
    else if (strcmp(argv[1], "reports") == 0)
        result = reports(connection, argv[4], atof(argv[5]));
    IedConnection_destroy(connection);
    if (tls)
        TLSConfiguration_destroy(tls);
    return result;
}
