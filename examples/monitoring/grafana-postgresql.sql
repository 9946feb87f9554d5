-- Queries of a Grafana data source "PostgreSQL" on the service's database, and the role that it logs in as.
-- Each query stands below its name. $__unixEpochNanoFrom() and so on are Grafana's own macros; $motor is a
-- variable of the dashboard. Times are nanoseconds since 1970 in UTC.

-- role: run once by the database's owner, with a password of your own
CREATE ROLE grafana LOGIN PASSWORD 'choose one' NOSUPERUSER NOCREATEDB NOCREATEROLE CONNECTION LIMIT 10;
ALTER ROLE grafana SET default_transaction_read_only = on;
ALTER ROLE grafana SET statement_timeout = '10s';
GRANT SELECT ON motors, conditions, diagnoses, alarms, rotor_findings, record_figures TO grafana;

-- query: motors, for the variable $motor
SELECT name FROM motors WHERE in_service ORDER BY name;

-- query: fault level of a motor over time
SELECT to_timestamp(recorded_ns / 1e9) AS time,
       100 * mu_f AS "level [%]",
       100 * mu_f_ci95_low AS "lower end [%]",
       100 * mu_f_ci95_high AS "upper end [%]",
       100 * load_level AS "load [%]"
FROM diagnoses
WHERE motor = '$motor' AND "current" AND NOT says_nothing
  AND recorded_ns BETWEEN $__unixEpochNanoFrom() AND $__unixEpochNanoTo()
ORDER BY recorded_ns;

-- query: motors that need attention
SELECT conditions.motor, motors.site, conditions.state, conditions.kind, conditions.phase,
       100 * conditions.mu_f AS "level [%]",
       to_timestamp(conditions.since_ns / 1e9) AS since
FROM conditions JOIN motors ON motors.name = conditions.motor
WHERE motors.in_service AND conditions.state IN ('watch', 'fault')
ORDER BY conditions.state, conditions.mu_f DESC NULLS LAST;

-- query: asymmetry of the rotor over time
SELECT to_timestamp(time_ns / 1e9) AS time, "severity_dB", "detection_limit_dB"
FROM rotor_findings
WHERE motor = '$motor' AND time_ns BETWEEN $__unixEpochNanoFrom() AND $__unixEpochNanoTo()
ORDER BY time_ns;

-- query: alarms that stand, as annotations
SELECT to_timestamp(raised_ns / 1e9) AS time, to_timestamp(cleared_ns / 1e9) AS "timeEnd",
       reason AS text, kind AS tags
FROM alarms
WHERE motor = '$motor' AND raised_ns BETWEEN $__unixEpochNanoFrom() AND $__unixEpochNanoTo()
ORDER BY raised_ns;
