"""Result and argument types of every libiec61850 1.6.1 function used here, and the types of its callbacks."""

from ctypes import (
    CFUNCTYPE,
    POINTER,
    Structure,
    c_bool,
    c_char_p,
    c_double,
    c_int,
    c_int8,
    c_int16,
    c_int32,
    c_int64,
    c_uint8,
    c_uint16,
    c_uint32,
    c_uint64,
    c_void_p,
)
from typing import Final

_ERROR = POINTER(c_int)
_BYTES = POINTER(c_uint8)
_FLAG = POINTER(c_bool)


class LastApplError(Structure):
    """The library's struct LastApplError: IEC 61850-8-1 LastApplError without its object and origin."""

    _fields_ = [("ctlNum", c_int), ("error", c_int), ("addCause", c_int)]


class VariableAccessSpecification(Structure):
    """The library's MmsVariableAccessSpecification; the index is -1 where there is none."""

    _fields_ = [("domain", c_char_p), ("item", c_char_p), ("index", c_int32), ("component", c_char_p)]


# void (parameter, connection)
ConnectionClosedHandler = CFUNCTYPE(None, c_void_p, c_void_p)
# void (parameter, connection, state)
StateChangedHandler = CFUNCTYPE(None, c_void_p, c_void_p, c_int)
# void (parameter, report)
ReportHandler = CFUNCTYPE(None, c_void_p, c_void_p)
# void (parameter, control)
CommandTerminationHandler = CFUNCTYPE(None, c_void_p, c_void_p)
# void (parameter, file name, size, last modified)
FileDirectoryHandler = CFUNCTYPE(None, c_void_p, c_char_p, c_uint32, c_uint64)
# void (parameter, frsm id, buffer, bytes)
FileReadHandler = CFUNCTYPE(None, c_void_p, c_int32, _BYTES, c_uint32)
# void (invoke id, parameter, error, frsm id, buffer, bytes, more follows)
FileReadAsyncHandler = CFUNCTYPE(None, c_uint32, c_void_p, c_int, c_int32, _BYTES, c_uint32, c_bool)
# ControlHandlerResult (action, parameter, value, test)
ControlHandler = CFUNCTYPE(c_int, c_void_p, c_void_p, c_void_p, c_bool)
# ControlHandlerResult (action, parameter, value, test, synchro check)
WaitForExecutionHandler = CFUNCTYPE(c_int, c_void_p, c_void_p, c_void_p, c_bool, c_bool)
# MmsError (parameter, connection, service, local file name, other file name)
FileAccessHandler = CFUNCTYPE(c_int, c_void_p, c_void_p, c_int, c_char_p, c_char_p)
# MmsDataAccessError (logical device, logical node, data object, constraint, connection, parameter)
ReadAccessHandler = CFUNCTYPE(c_int, c_void_p, c_void_p, c_void_p, c_int, c_void_p, c_void_p)

# void (parameter, level, code, message, TLS connection)
TlsEventHandler = CFUNCTYPE(None, c_void_p, c_int, c_int, c_char_p, c_void_p)
# bool (parameter, authentication parameter, security token, application reference)
Authenticator = CFUNCTYPE(c_bool, c_void_p, c_void_p, c_void_p, c_void_p)

PROTOTYPES: Final[dict[str, tuple[object, list[object]]]] = {
    # linked lists
    "LinkedList_create": (c_void_p, []),
    "LinkedList_add": (None, [c_void_p, c_void_p]),
    "LinkedList_getNext": (c_void_p, [c_void_p]),
    "LinkedList_getData": (c_void_p, [c_void_p]),
    "LinkedList_destroy": (None, [c_void_p]),
    "LinkedList_destroyStatic": (None, [c_void_p]),
    # values
    "MmsValue_getType": (c_int, [c_void_p]),
    "MmsValue_getArraySize": (c_uint32, [c_void_p]),
    "MmsValue_getElement": (c_void_p, [c_void_p, c_int]),
    "MmsValue_getDataAccessError": (c_int, [c_void_p]),
    "MmsValue_getBoolean": (c_bool, [c_void_p]),
    "MmsValue_setBoolean": (None, [c_void_p, c_bool]),
    "MmsValue_toInt64": (c_int64, [c_void_p]),
    "MmsValue_setInt8": (None, [c_void_p, c_int8]),
    "MmsValue_setInt16": (None, [c_void_p, c_int16]),
    "MmsValue_setInt32": (None, [c_void_p, c_int32]),
    "MmsValue_setInt64": (None, [c_void_p, c_int64]),
    "MmsValue_toUint32": (c_uint32, [c_void_p]),
    "MmsValue_setUint8": (None, [c_void_p, c_uint8]),
    "MmsValue_setUint16": (None, [c_void_p, c_uint16]),
    "MmsValue_setUint32": (None, [c_void_p, c_uint32]),
    "MmsValue_toDouble": (c_double, [c_void_p]),
    "MmsValue_setDouble": (None, [c_void_p, c_double]),
    "MmsValue_toString": (c_char_p, [c_void_p]),
    "MmsValue_setVisibleString": (None, [c_void_p, c_char_p]),
    "MmsValue_setMmsString": (None, [c_void_p, c_char_p]),
    "MmsValue_getBitStringSize": (c_int, [c_void_p]),
    "MmsValue_getBitStringBit": (c_bool, [c_void_p, c_int]),
    "MmsValue_setBitStringBit": (None, [c_void_p, c_int, c_bool]),
    "MmsValue_getUtcTimeBuffer": (_BYTES, [c_void_p]),
    "MmsValue_setUtcTimeByBuffer": (None, [c_void_p, c_char_p]),
    "MmsValue_getBinaryTimeAsUtcMs": (c_uint64, [c_void_p]),
    "MmsValue_setBinaryTime": (None, [c_void_p, c_uint64]),
    "MmsValue_getOctetStringSize": (c_uint16, [c_void_p]),
    "MmsValue_getOctetStringMaxSize": (c_uint16, [c_void_p]),
    "MmsValue_getOctetStringBuffer": (_BYTES, [c_void_p]),
    "MmsValue_setOctetString": (None, [c_void_p, c_char_p, c_int]),
    "MmsValue_newOctetString": (c_void_p, [c_int, c_int]),
    "MmsValue_newBoolean": (c_void_p, [c_bool]),
    "MmsValue_clone": (c_void_p, [c_void_p]),
    "MmsValue_delete": (None, [c_void_p]),
    # TLS
    "TLSConfiguration_create": (c_void_p, []),
    "TLSConfiguration_destroy": (None, [c_void_p]),
    "TLSConfiguration_setEventHandler": (None, [c_void_p, TlsEventHandler, c_void_p]),
    "TLSConfiguration_setChainValidation": (None, [c_void_p, c_bool]),
    "TLSConfiguration_setTimeValidation": (None, [c_void_p, c_bool]),
    "TLSConfiguration_setAllowOnlyKnownCertificates": (None, [c_void_p, c_bool]),
    "TLSConfiguration_enableSessionResumption": (None, [c_void_p, c_bool]),
    "TLSConfiguration_setMinTlsVersion": (None, [c_void_p, c_int]),
    "TLSConfiguration_setMaxTlsVersion": (None, [c_void_p, c_int]),
    "TLSConfiguration_clearCipherSuiteList": (None, [c_void_p]),
    "TLSConfiguration_addCipherSuite": (None, [c_void_p, c_int]),
    "TLSConfiguration_setOwnKey": (c_bool, [c_void_p, c_char_p, c_int, c_char_p]),
    "TLSConfiguration_setOwnCertificate": (c_bool, [c_void_p, c_char_p, c_int]),
    "TLSConfiguration_addAllowedCertificate": (c_bool, [c_void_p, c_char_p, c_int]),
    "TLSConfiguration_addCACertificate": (c_bool, [c_void_p, c_char_p, c_int]),
    "TLSConnection_getTLSVersion": (c_int, [c_void_p]),
    # passwords
    "AcseAuthenticationParameter_create": (c_void_p, []),
    "AcseAuthenticationParameter_destroy": (None, [c_void_p]),
    "AcseAuthenticationParameter_setAuthMechanism": (None, [c_void_p, c_int]),
    "AcseAuthenticationParameter_setPassword": (None, [c_void_p, c_char_p]),
    "AcseAuthenticationParameter_getAuthMechanism": (c_int, [c_void_p]),
    "AcseAuthenticationParameter_getPassword": (c_void_p, [c_void_p]),
    "AcseAuthenticationParameter_getPasswordLength": (c_int, [c_void_p]),
    "MmsConnection_getIsoConnectionParameters": (c_void_p, [c_void_p]),
    "IsoConnectionParameters_setAcseAuthenticationParameter": (None, [c_void_p, c_void_p]),
    # client: association
    "IedConnection_createEx": (c_void_p, [c_void_p, c_bool]),
    "IedConnection_destroy": (None, [c_void_p]),
    "IedConnection_connectAsync": (None, [c_void_p, _ERROR, c_char_p, c_int]),
    "IedConnection_tick": (c_bool, [c_void_p]),
    "IedConnection_installStateChangedHandler": (None, [c_void_p, StateChangedHandler, c_void_p]),
    "IedConnection_setConnectTimeout": (None, [c_void_p, c_uint32]),
    "IedConnection_setRequestTimeout": (None, [c_void_p, c_uint32]),
    "IedConnection_installConnectionClosedHandler": (None, [c_void_p, ConnectionClosedHandler, c_void_p]),
    "IedConnection_getMmsConnection": (c_void_p, [c_void_p]),
    # client: directories, data, data sets
    "MmsConnection_getDomainNames": (c_void_p, [c_void_p, _ERROR]),
    "MmsConnection_getDomainVariableNames": (c_void_p, [c_void_p, _ERROR, c_char_p]),
    "MmsConnection_getDomainVariableListNames": (c_void_p, [c_void_p, _ERROR, c_char_p]),
    "MmsConnection_readVariable": (c_void_p, [c_void_p, _ERROR, c_char_p, c_char_p]),
    "MmsConnection_readSingleArrayElementWithComponent": (
        c_void_p,
        [c_void_p, _ERROR, c_char_p, c_char_p, c_uint32, c_char_p],
    ),
    "MmsConnection_readNamedVariableListDirectory": (c_void_p, [c_void_p, _ERROR, c_char_p, c_char_p, _FLAG]),
    "MmsVariableAccessSpecification_destroy": (None, [c_void_p]),
    "MmsConnection_readMultipleVariables": (c_void_p, [c_void_p, _ERROR, c_char_p, c_void_p]),
    "MmsConnection_readNamedVariableListValues": (c_void_p, [c_void_p, _ERROR, c_char_p, c_char_p, c_bool]),
    # client: reports
    "IedConnection_getRCBValues": (c_void_p, [c_void_p, _ERROR, c_char_p, c_void_p]),
    "IedConnection_setRCBValues": (None, [c_void_p, _ERROR, c_void_p, c_uint32, c_bool]),
    "IedConnection_installReportHandler": (None, [c_void_p, c_char_p, c_char_p, ReportHandler, c_void_p]),
    "IedConnection_uninstallReportHandler": (None, [c_void_p, c_char_p]),
    "ClientReportControlBlock_destroy": (None, [c_void_p]),
    "ClientReportControlBlock_getRptId": (c_char_p, [c_void_p]),
    "ClientReportControlBlock_getDataSetReference": (c_char_p, [c_void_p]),
    "ClientReportControlBlock_getRptEna": (c_bool, [c_void_p]),
    "ClientReportControlBlock_setRptEna": (None, [c_void_p, c_bool]),
    "ClientReportControlBlock_setResv": (None, [c_void_p, c_bool]),
    "ClientReportControlBlock_getOptFlds": (c_int, [c_void_p]),
    "ClientReportControlBlock_setOptFlds": (None, [c_void_p, c_int]),
    "ClientReportControlBlock_setEntryId": (None, [c_void_p, c_void_p]),
    "ClientReportControlBlock_setGI": (None, [c_void_p, c_bool]),
    "ClientReport_getRptId": (c_char_p, [c_void_p]),
    "ClientReport_getEntryId": (c_void_p, [c_void_p]),
    "ClientReport_hasSeqNum": (c_bool, [c_void_p]),
    "ClientReport_getSeqNum": (c_uint16, [c_void_p]),
    "ClientReport_hasTimestamp": (c_bool, [c_void_p]),
    "ClientReport_getTimestamp": (c_uint64, [c_void_p]),
    "ClientReport_hasBufOvfl": (c_bool, [c_void_p]),
    "ClientReport_getBufOvfl": (c_bool, [c_void_p]),
    "ClientReport_hasDataSetName": (c_bool, [c_void_p]),
    "ClientReport_getDataSetName": (c_char_p, [c_void_p]),
    "ClientReport_hasDataReference": (c_bool, [c_void_p]),
    "ClientReport_getDataReference": (c_char_p, [c_void_p, c_int]),
    "ClientReport_getDataSetValues": (c_void_p, [c_void_p]),
    "ClientReport_getReasonForInclusion": (c_int, [c_void_p, c_int]),
    "ClientReport_getMoreSeqmentsFollow": (c_bool, [c_void_p]),
    # client: controls
    "MmsConnection_getVariableAccessAttributes": (c_void_p, [c_void_p, _ERROR, c_char_p, c_char_p]),
    "MmsVariableSpecification_destroy": (None, [c_void_p]),
    "ControlObjectClient_createEx": (c_void_p, [c_char_p, c_void_p, c_int, c_void_p]),
    "ControlObjectClient_destroy": (None, [c_void_p]),
    "ControlObjectClient_getControlModel": (c_int, [c_void_p]),
    "ControlObjectClient_setOrigin": (None, [c_void_p, c_char_p, c_int]),
    "ControlObjectClient_setCtlNum": (None, [c_void_p, c_uint8]),
    "ControlObjectClient_select": (c_bool, [c_void_p]),
    "ControlObjectClient_selectWithValue": (c_bool, [c_void_p, c_void_p]),
    "ControlObjectClient_operate": (c_bool, [c_void_p, c_void_p, c_uint64]),
    "ControlObjectClient_getLastError": (c_int, [c_void_p]),
    "ControlObjectClient_getLastApplError": (LastApplError, [c_void_p]),
    "ControlObjectClient_setCommandTerminationHandler": (
        None,
        [c_void_p, CommandTerminationHandler, c_void_p],
    ),
    # client: files
    "MmsConnection_getFileDirectory": (
        c_bool,
        [c_void_p, _ERROR, c_char_p, c_char_p, FileDirectoryHandler, c_void_p],
    ),
    "MmsConnection_fileOpen": (
        c_int32,
        [c_void_p, _ERROR, c_char_p, c_uint32, POINTER(c_uint32), POINTER(c_uint64)],
    ),
    "MmsConnection_fileRead": (c_bool, [c_void_p, _ERROR, c_int32, FileReadHandler, c_void_p]),
    "MmsConnection_fileReadAsync": (
        None,
        [c_void_p, POINTER(c_uint32), _ERROR, c_int32, FileReadAsyncHandler, c_void_p],
    ),
    "MmsConnection_fileClose": (None, [c_void_p, _ERROR, c_int32]),
    # server: model
    "ConfigFileParser_createModelFromConfigFileEx": (c_void_p, [c_char_p]),
    "IedModel_destroy": (None, [c_void_p]),
    "IedModel_setIedNameForDynamicModel": (None, [c_void_p, c_char_p]),
    "IedModel_getModelNodeByObjectReference": (c_void_p, [c_void_p, c_char_p]),
    "ModelNode_getType": (c_int, [c_void_p]),
    "DataAttribute_getType": (c_int, [c_void_p]),
    # server
    "IedServerConfig_create": (c_void_p, []),
    "IedServerConfig_destroy": (None, [c_void_p]),
    "IedServerConfig_setMaxMmsConnections": (None, [c_void_p, c_int]),
    "IedServerConfig_setReportBufferSize": (None, [c_void_p, c_int]),
    "IedServerConfig_setReportBufferSizeForURCBs": (None, [c_void_p, c_int]),
    "IedServerConfig_enableFileService": (None, [c_void_p, c_bool]),
    "IedServerConfig_setFileServiceBasePath": (None, [c_void_p, c_char_p]),
    "IedServerConfig_enableDynamicDataSetService": (None, [c_void_p, c_bool]),
    "IedServerConfig_setMaxDomainSpecificDataSets": (None, [c_void_p, c_int]),
    "IedServerConfig_setMaxAssociationSpecificDataSets": (None, [c_void_p, c_int]),
    "IedServerConfig_setMaxDataSetEntries": (None, [c_void_p, c_int]),
    "IedServerConfig_setReportSetting": (None, [c_void_p, c_uint8, c_bool]),
    "IedServerConfig_enableLogService": (None, [c_void_p, c_bool]),
    "IedServerConfig_useIntegratedGoosePublisher": (None, [c_void_p, c_bool]),
    "IedServer_createWithConfig": (c_void_p, [c_void_p, c_void_p, c_void_p]),
    "IedServer_destroy": (None, [c_void_p]),
    "IedServer_setAuthenticator": (None, [c_void_p, Authenticator, c_void_p]),
    "IedServer_setLocalIpAddress": (None, [c_void_p, c_char_p]),
    "IedServer_setServerIdentity": (None, [c_void_p, c_char_p, c_char_p, c_char_p]),
    "IedServer_setReadAccessHandler": (None, [c_void_p, ReadAccessHandler, c_void_p]),
    "IedServer_setWriteAccessPolicy": (None, [c_void_p, c_int, c_int]),
    "IedServer_startThreadless": (None, [c_void_p, c_int]),
    "IedServer_stopThreadless": (None, [c_void_p]),
    "IedServer_isRunning": (c_bool, [c_void_p]),
    "IedServer_waitReady": (c_int, [c_void_p, c_uint32]),
    "IedServer_processIncomingData": (None, [c_void_p]),
    "IedServer_performPeriodicTasks": (None, [c_void_p]),
    "IedServer_getNumberOfOpenConnections": (c_int, [c_void_p]),
    "IedServer_getMmsServer": (c_void_p, [c_void_p]),
    "MmsServer_installFileAccessHandler": (None, [c_void_p, FileAccessHandler, c_void_p]),
    "IedServer_lockDataModel": (None, [c_void_p]),
    "IedServer_unlockDataModel": (None, [c_void_p]),
    "IedServer_getAttributeValue": (c_void_p, [c_void_p, c_void_p]),
    "IedServer_updateAttributeValue": (None, [c_void_p, c_void_p, c_void_p]),
    "MmsValue_update": (c_bool, [c_void_p, c_void_p]),
    "MmsValue_equals": (c_bool, [c_void_p, c_void_p]),
    # server: controls
    "IedServer_setControlHandler": (None, [c_void_p, c_void_p, ControlHandler, c_void_p]),
    "IedServer_setWaitForExecutionHandler": (None, [c_void_p, c_void_p, WaitForExecutionHandler, c_void_p]),
    "ControlAction_setAddCause": (None, [c_void_p, c_int]),
    "ControlAction_getOrCat": (c_int, [c_void_p]),
    "ControlAction_getOrIdent": (_BYTES, [c_void_p, POINTER(c_int)]),
    "ControlAction_getCtlNum": (c_int, [c_void_p]),
}
