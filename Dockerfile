# One image for every host of the demo enterprise, and for the service in a real plant (docs/how-to/deploy.md).

FROM docker.io/library/python:3.11-slim-bookworm AS build
ENV PIP_NO_CACHE_DIR=1 PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_ROOT_USER_ACTION=ignore
RUN python -m venv /opt/statorwatch
WORKDIR /src
# The libraries come first: they change seldom, and this layer is then kept.
COPY requirements.txt ./
# PostgreSQL's driver, the client of S3-compatible stores and the readers of tables (Parquet, MATLAB 7.3, TDMS)
# are among them, since an image cannot be added to.
# A file whose hash is not in requirements.txt is not installed.
RUN /opt/statorwatch/bin/pip install --require-hashes --requirement requirements.txt \
 # The client describes all of a cloud's services; stores of recordings are S3, and these say who asks.
 && find /opt/statorwatch/lib/python3*/site-packages/botocore/data -mindepth 1 -maxdepth 1 -type d \
    ! -name s3 ! -name sts ! -name sso ! -name sso-oidc ! -name signin -exec rm -rf {} +
COPY . .
# What builds the wheel, pinned too: pip up to 25.2 reads the first of the two for it, later ones the second.
RUN echo "setuptools==84.2.1" > build-constraints.txt \
 && cat constraints.txt >> build-constraints.txt \
 && PIP_CONSTRAINT=/src/build-constraints.txt PIP_BUILD_CONSTRAINT=/src/build-constraints.txt \
    python -m pip wheel --no-deps --wheel-dir /wheels . \
 && /opt/statorwatch/bin/pip install --no-deps /wheels/*.whl \
 && /opt/statorwatch/bin/pip uninstall --yes pip setuptools \
 && find /opt/statorwatch -type d -name tests -prune -exec rm -rf {} + \
 && /opt/statorwatch/bin/python -m scl.demo_enterprise /src/plant.scd

FROM docker.io/library/python:3.11-slim-bookworm
LABEL org.opencontainers.image.title="StatorWatch" org.opencontainers.image.licenses="GPL-3.0-or-later"
RUN useradd --uid 10001 --no-create-home --home-dir /tmp --shell /usr/sbin/nologin statorwatch \
 && install --directory --owner statorwatch --group statorwatch --mode 0700 /data /token /recordings
COPY --from=build /opt/statorwatch /opt/statorwatch
ENV PATH=/opt/statorwatch/bin:$PATH PYTHONUNBUFFERED=1 PYTHONDONTWRITEBYTECODE=1 OPENBLAS_NUM_THREADS=1
# The machine models, compiled. Numba compares a source's time to the nanosecond, layers keep whole seconds.
# A container's copy lies in /tmp, because Numba uses no cache it cannot write to.
RUN cd "$(python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')" \
 && find core ied_sim -name '*.py' -exec touch --date 2025-01-01 {} + \
 && python -m compileall -q core ied_sim \
 && NUMBA_CACHE_DIR=/opt/statorwatch/compiled python -c 'import core.warm_up, ied_sim; core.warm_up.warm_up(); ied_sim.warm_up()'
ENV NUMBA_CACHE_DIR=/tmp/compiled
COPY --from=build /src/plant.scd /src/service/demo/motors.toml /src/service/demo/scenario.toml /plant/
ENV MCC_SCD=/plant/plant.scd MCC_MOTORS=/plant/motors.toml MCC_DATA_DIRECTORY=/data MCC_BIND_ADDRESS=0.0.0.0
USER 10001:10001
WORKDIR /data
EXPOSE 8710
HEALTHCHECK --interval=30s --timeout=5s --start-period=60s \
    CMD ["python", "-c", "import urllib.request as r; r.urlopen('http://127.0.0.1:8710/readyz', timeout=4)"]
ENTRYPOINT ["/bin/sh", "-c", "[ -e /tmp/compiled ] || cp -R /opt/statorwatch/compiled /tmp/; exec \"$@\"", "statorwatch"]
CMD ["mcc", "serve"]
