# galinx in a container:
#   docker build -t galinx .
#   docker run --rm -u "$(id -u):$(id -g)" -v "$PWD:/work" galinx run scene.toml
FROM debian:12-slim
COPY . /opt/galinx
# The first command installs Debian's packages.
RUN /opt/galinx/run.sh --version && rm -rf /var/lib/apt/lists/*
ENV PATH=/opt/galinx/bin:$PATH XDG_CACHE_HOME=/tmp/cache
WORKDIR /work
ENTRYPOINT ["galinx"]
CMD ["--help"]
